"""Pause a run between two steps and let it go on afterwards, or end one because the host is silent."""

from amaranth.hdl import Module, Mux, Signal, signed
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from hw.link.port import LATENCY
from hw.link.states import check_states
from hw.machine.interfaces import HostAccess
from hw.map.control import Control
from hw.map.memory_map import Region, join

PAUSE = "stop", "stopping", "stopped", "counting", "left", "done"
"""States of a pause: write STOP, wait for its answer and for the run's end, read STEPS_DONE."""
RESUME = "go", "asked", "done"
"""States in which the rest of a run begins: write RUN."""
HALT = "halt", "asked", "done"
IDLE = ("idle",)

_ACCESS = 1 + LATENCY
"""Cycles of an access: its register, and the answer's way."""


def _cycles(path: tuple[str, ...]) -> int:
    return sum(_ACCESS if state in ("stopping", "counting", "asked") else 1 for state in path)


PAUSE_CYCLES = _cycles(PAUSE)
"""Cycles from ``pause`` to ``done``, if the run is over when STOP is answered; else those of its step come on top."""
RESUME_CYCLES = _cycles(RESUME)
"""Cycles from ``resume`` to ``done``."""


class Pause(wiring.Component):
    """Stop the run that is under way, and let the rest of it run later. Uses the host port while nobody else does.

    Parameters
    ----------
    state : int
        Bits of a word.

    Members
    -------
    pause, resume, halt : In(1)
        Stop the run after its step; let the rest of it run; stop it for good. One at a time, not again before ``done``.
    done : Out(1)
        The request is done.
    noted : In(1), steps : In(32)
        The host began a run of so many steps, or ended it (0): nothing is left of an earlier one.
    busy : In(1)
    port : Out(HostAccess)
    """

    def __init__(self, state: int):
        strobes = {name: In(1) for name in ("pause", "resume", "halt", "noted", "busy")}
        super().__init__({**strobes, "steps": In(32), "done": Out(1), "port": Out(HostAccess(state))})

    def elaborate(self, platform):
        m = Module()
        run = Signal.like(self.steps)
        left = Signal.like(self.steps)
        rest = Signal(signed(len(run) + 1))
        some = Signal()
        m.d.sync += [some.eq(left != 0), self.port.request.eq(0)]
        with m.If(self.noted):
            m.d.sync += [run.eq(self.steps), left.eq(0)]
        with m.FSM() as machine:
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
                self._access(m, Control.STOP, "stopping", write=1)
            with m.State("stopping"):
                with m.If(self.port.answer):
                    m.next = "stopped"
            with m.State("stopped"):
                with m.If(~self.busy):
                    self._access(m, Control.STEPS_DONE, "counting")
            with m.State("counting"):
                m.d.sync += rest.eq(run - self.port.read_data[: len(run)])
                with m.If(self.port.answer):
                    m.next = "left"
            with m.State("left"):
                m.d.sync += left.eq(Mux(rest < 0, 0, rest))
                m.next = "done"
            with m.State("halt"):
                m.d.sync += left.eq(0)
                self._access(m, Control.STOP, "asked", write=1)
            with m.State("go"):
                m.d.sync += [run.eq(left), left.eq(0)]
                self._access(m, Control.RUN, "asked", write=left)
            with m.State("asked"):
                with m.If(self.port.answer):
                    m.next = "done"
            with m.State("done"):
                m.d.comb += self.done.eq(1)
                m.next = "idle"
        check_states(machine.encoding, IDLE, PAUSE, RESUME, HALT)
        return m

    def _access(self, m: Module, register: Control, following: str, write=None):
        """Access a control register; the following state waits for the answer."""
        m.d.sync += [self.port.request.eq(1), self.port.address.eq(join(Region.CONTROL, 0, register, 0))]
        m.d.sync += self.port.write.eq(write is not None)
        if write is not None:
            m.d.sync += self.port.write_data.eq(write)
        m.next = following
