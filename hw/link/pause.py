"""A run that pauses with its step and goes on afterwards, and one that ends because the host is silent."""

from amaranth.hdl import Module, Mux, Signal, signed
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from hw.machine.interfaces import HostAccess
from hw.map.control import Control
from hw.map.memory_map import Region, join


class Pause(wiring.Component):
    """Stops the run that goes on, and lets what is left of it run later: on the host port, while nobody else uses it.

    Parameters
    ----------
    state : int
        Bits of a word.

    Members
    -------
    pause, resume, halt : In(1)
        Begin: to stop the run with its step; to let what is left of it go on; to stop it for good. One at a time, not
        again before ``done``.
    done : Out(1)
        What was begun is through.
    noted : In(1), steps : In(32)
        The host began a run of so many steps, or ended it (0): nothing is left of an earlier one.
    busy : In(1)
    port : Out(HostAccess)
    """

    def __init__(self, state: int):
        begin = dict.fromkeys(("pause", "resume", "halt", "noted", "busy"), In(1))
        super().__init__({**begin, "steps": In(32), "done": Out(1), "port": Out(HostAccess(state))})

    def elaborate(self, platform):
        m = Module()
        run = Signal.like(self.steps)
        left = Signal.like(self.steps)
        rest = Signal(signed(len(run) + 1))
        some = Signal()
        m.d.sync += some.eq(left != 0)
        with m.If(self.noted):
            m.d.sync += [run.eq(self.steps), left.eq(0)]

        def ask(register, following, write=None):
            """An access to a control register; the next state waits for its answer."""
            m.d.sync += [self.port.request.eq(1), self.port.address.eq(join(Region.CONTROL, 0, register, 0))]
            m.d.sync += self.port.write.eq(write is not None)
            if write is not None:
                m.d.sync += self.port.write_data.eq(write)
            m.next = following

        m.d.sync += self.port.request.eq(0)

        with m.FSM():
            with m.State("idle"):
                with m.If(self.pause):
                    m.next = "stop"
                with m.Elif(self.halt):
                    m.next = "halt"
                with m.Elif(self.resume):
                    m.next = "done"
                    with m.If(some):
                        m.next = "go"
            with m.State("stop"):
                ask(Control.STOP, "stopping", write=1)
            with m.State("halt"):
                m.d.sync += left.eq(0)
                ask(Control.STOP, "asked", write=1)
            with m.State("go"):
                m.d.sync += [run.eq(left), left.eq(0)]
                ask(Control.RUN, "asked", write=left)
            with m.State("stopping"):
                with m.If(self.port.answer):
                    m.next = "stopped"
            with m.State("stopped"):
                with m.If(~self.busy):
                    ask(Control.STEPS_DONE, "counted")
            with m.State("counted"):
                m.d.sync += rest.eq(run - self.port.read_data[: len(run)])
                with m.If(self.port.answer):
                    m.next = "rest"
            with m.State("rest"):
                m.d.sync += left.eq(Mux(rest < 0, 0, rest))
                m.next = "done"
            with m.State("asked"):
                with m.If(self.port.answer):
                    m.next = "done"
            with m.State("done"):
                m.d.comb += self.done.eq(1)
                m.next = "idle"
        return m
