"""A count of the entries of one list that are done, for the entries of the other list that wait for them."""

from amaranth.hdl import Cat, Module, Mux, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from hw.machine.interfaces import Completion

LATENCY = 1
"""Cycles from a completion to the outputs that count it."""


class CompletionCounter(wiring.Component):
    """Counts a list's entries as they are done, and compares the count with what the other list's entries need.

    Three entries of the other list are compared, the one in its issue register and the two after it, all a cycle
    ahead, because the comparator is slow. Latency `LATENCY`.

    Parameters
    ----------
    width : int
        Bits of a need, and of the count.
    first : int
        0 or 1: the count while nothing of the list is done.

    Members
    -------
    clear : In(1)
        Nothing is done.
    completion : In(Completion)
        With a list's last entry the count begins again.
    need, next_need, second_need : In
        The needs of the entry in the issue register and of the two after it. A need is met if it is below the count.
    advances : In(1)
        In the next cycle the next entry is in the issue register.
    reached, next_reached : Out(1)
        The needs of the entry in the issue register and of the next are met by the count in this cycle.

    Raises
    ------
    ValueError
        If `LATENCY` isn't 1: there is one register.
    """

    def __init__(self, *, width: int, first: int):
        if LATENCY != 1:
            raise ValueError(f"the latency of a completion counter must be 1, not {LATENCY}")
        self._first = first
        self.kind = f"completion_counter_{width}_from_{first}"
        super().__init__(
            {
                "clear": In(1),
                "completion": In(Completion()),
                "need": In(width),
                "next_need": In(width),
                "second_need": In(width),
                "advances": In(1),
                "reached": Out(1),
                "next_reached": Out(1),
            }
        )

    def elaborate(self, platform):
        m, done, last = Module(), self.completion.done, self.completion.last
        count = Signal.like(self.need, name="count", reset_less=True)  # the list's last entry sets it back
        with m.If(done):
            m.d.sync += count.eq(Mux(last, self._first, count + 1))
        with m.If(self.clear):
            m.d.sync += count.eq(self._first)

        def reached(need):
            """``need < count`` as of the next cycle: one more that is done is one more bit to compare."""
            none_done = ~need.any() if self._first else 0
            return Mux(done & last, none_done, Cat(~done, need) < Cat(1, count))

        entry, following, second = (reached(need) for need in (self.need, self.next_need, self.second_need))
        m.d.sync += [
            self.reached.eq(Mux(self.advances, following, entry)),
            self.next_reached.eq(Mux(self.advances, second, following)),
        ]
        return m
