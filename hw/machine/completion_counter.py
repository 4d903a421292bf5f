"""How far one list has come, and whether that is what the entries of the other wait for: known from registers."""

from amaranth.hdl import Cat, Module, Mux, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out


class CompletionCounter(wiring.Component):
    """Counts a list's entries as they are done, and compares the number with what the entries of another list need.

    The other list's entries stand one behind the other: the one in front, the one behind it and the one after that
    (`hw.machine.issue_register`, `hw.machine.fetch`). Where each of them will stand in the next cycle is known before
    what is done by then, so that comparing, which takes long, is over before it matters.

    Parameters
    ----------
    width : int
        Bits of what an entry needs, and of the count.
    first : int
        0 or 1: what is counted from.

    Members
    -------
    clear : In(1)
        Nothing is done.
    done, done_last : In(1)
        One more entry is done; it is its list's last, with which the count begins again.
    front, behind, after : In
        What the entries need: each of them less than the count.
    moves : In(1)
        In the next cycle the entry behind is in front, the one after that is behind.
    front_reached, behind_reached : Out(1)
        There is what is needed, as the count is in this cycle.
    """

    def __init__(self, *, width: int, first: int):
        self._first = first
        self.kind = f"completion_counter_{width}_from_{first}"
        super().__init__(
            {
                "clear": In(1),
                "done": In(1),
                "done_last": In(1),
                "front": In(width),
                "behind": In(width),
                "after": In(width),
                "moves": In(1),
                "front_reached": Out(1),
                "behind_reached": Out(1),
            }
        )

    def elaborate(self, platform):
        m = Module()
        count = Signal.like(self.front, reset_less=True)  # of less than the list's last
        with m.If(self.done):
            m.d.sync += count.eq(Mux(self.done_last, self._first, count + 1))
        with m.If(self.clear):
            m.d.sync += count.eq(self._first)

        def reached(need):
            """``need < count``, the count as it will be in the next cycle: one more is a bit more to compare."""
            none_done = ~need.any() if self._first else 0
            return Mux(self.done & self.done_last, none_done, Cat(~self.done, need) < Cat(1, count))

        front, behind, after = (reached(need) for need in (self.front, self.behind, self.after))
        m.d.sync += [
            self.front_reached.eq(Mux(self.moves, behind, front)),
            self.behind_reached.eq(Mux(self.moves, after, behind)),
        ]
        return m
