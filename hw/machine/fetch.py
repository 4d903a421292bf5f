"""Reads a list again and again, ahead of whoever works it off."""

from amaranth.hdl import Cat, Module, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from hw.blocks.memory import READ_LATENCY
from hw.blocks.queue import Queue
from hw.machine.issue_register import IssueRegister


def latency(data_latency: int) -> int:
    """Cycles from the end of the flush to the first entry."""
    return data_latency + 2


def members(index_bits: int, width: int) -> dict:
    """What `Fetch` and `PacedFetch` share."""
    return {
        "flush": In(1),
        "count": In(index_bits + 1),
        "address": Out(index_bits),
        "data": In(width),
        "valid": Out(1),
        "index": Out(index_bits),
        "last": Out(1),
        "word": Out(width),
        "next_word": Out(width),
    }


class Fetch(wiring.Component):
    """Entries 0 to ``count - 1`` of a memory over and over, one a cycle, each with its place in the list.

    Parameters
    ----------
    index_bits, width : int
    data_latency : int
        Of the memory, and of what is made of its words.

    The first entry comes `latency` cycles after the end of the flush.

    Members
    -------
    flush : In(1)
        Start over; held while idle.
    count : In
        Entries of the list, at least 1.
    address : Out, data : In
        To the memory.
    valid : Out(1), moves : In(1)
        There is an entry; it is taken, if there is one, and the next one comes.
    index, last, word : Out
        The entry: its place, whether it is the list's last, and what the memory holds there.
    next_word : Out
        ``word`` in the next cycle, if it ``moves`` and there is an entry then.
    """

    def __init__(self, *, index_bits: int, width: int, data_latency: int = READ_LATENCY):
        self._data_latency = data_latency
        self.kind = f"fetch_{width}"
        super().__init__({**members(index_bits, width), "moves": In(1)})

    def elaborate(self, platform):
        m = Module()
        depth = 1 << (self._data_latency + 3).bit_length()  # enough for an entry a cycle
        entry = Cat(self.word, self.last, self.index)
        m.submodules.queue = queue = Queue(width=len(entry), depth=depth)
        with m.If(self.moves):
            m.d.sync += [entry.eq(queue.data), self.valid.eq(queue.valid)]
        with m.If(self.flush):
            m.d.sync += self.valid.eq(0)
        under_way = Signal(range(depth + 1))  # entries asked for and not yet taken, as known a cycle later
        taken = Signal()
        ask = Signal()
        m.d.comb += ask.eq((under_way != depth) & ~self.flush)
        last, end = Signal(), Signal(len(self.address))  # the count stays as it is while entries are read
        m.d.sync += end.eq(self.count - 1)
        m.d.comb += last.eq(self.address == end)
        with m.If(self.flush):
            m.d.sync += [self.address.eq(0), under_way.eq(0), taken.eq(0)]
        with m.Else():
            m.d.sync += [taken.eq(self.moves & self.valid), under_way.eq(under_way + ask - taken)]
            with m.If(ask):
                m.d.sync += self.address.eq(self.address + 1)
                with m.If(last):
                    m.d.sync += self.address.eq(0)

        tag, arrived = Cat(last, self.address), ask
        for k in range(self._data_latency):
            tag_next, arrived_next = Signal(len(tag), name=f"tag_{k}"), Signal(name=f"arrived_{k}")
            m.d.sync += [tag_next.eq(tag), arrived_next.eq(arrived & ~self.flush)]
            tag, arrived = tag_next, arrived_next
        m.d.comb += [
            queue.flush.eq(self.flush),
            queue.put.eq(arrived),
            queue.data_in.eq(Cat(self.data, tag)),
            queue.take.eq(self.moves & queue.valid),
            self.next_word.eq(queue.data[: len(self.word)]),
        ]
        return m


class PacedFetch(wiring.Component):
    """A `Fetch` that knows when its entry moves to the list's `hw.machine.issue_register.IssueRegister`. It has
    the register that says so of its own: the queue hangs on it, and may stand far from the front.

    Members
    -------
    behind_ready, ready : In(1)
        As of the `hw.machine.issue_register.IssueRegister`.
    flush, count, address, data, valid, index, last, word, next_word
        As of `Fetch`.
    """

    def __init__(self, *, index_bits: int, width: int, data_latency: int = READ_LATENCY):
        self._sizes = {"index_bits": index_bits, "width": width, "data_latency": data_latency}
        self.kind = f"paced_fetch_{width}"
        self._shared = members(index_bits, width)
        super().__init__({**self._shared, "behind_ready": In(1), "ready": In(1)})

    def elaborate(self, platform):
        m = Module()
        m.submodules.fetch = fetch = Fetch(**self._sizes)
        m.submodules.pace = pace = IssueRegister(width=1)
        for name, member in self._shared.items():
            inner, outer = getattr(fetch, name), getattr(self, name)
            m.d.comb += inner.eq(outer) if member.flow == In else outer.eq(inner)
        m.d.comb += [
            pace.flush.eq(self.flush),
            pace.behind_valid.eq(fetch.valid),
            pace.behind_ready.eq(self.behind_ready),
            pace.ready.eq(self.ready),
            fetch.moves.eq(pace.moves),
        ]
        return m
