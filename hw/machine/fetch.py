"""Reads a list again and again, ahead of the issue of its entries."""

from amaranth.hdl import Cat, Module, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from hw.blocks.memory import READ_LATENCY
from hw.blocks.queue import LATENCY as QUEUE_LATENCY
from hw.blocks.queue import Queue
from hw.machine.interfaces import Advance, ListEntry
from hw.machine.issue_register import IssueRegister


def latency(data_latency: int) -> int:
    """Return the cycles from the end of the flush to the first entry: memory, queue, and the entry's register."""
    return data_latency + QUEUE_LATENCY + 1


def members(index_bits: int, width: int) -> dict:
    """Return the ports that `Fetch` and `PacedFetch` share."""
    return {
        "flush": In(1),
        "count": In(index_bits + 1),
        "address": Out(index_bits),
        "data": In(width),
        "entry": Out(ListEntry(index_bits, width)),
        "second_word": Out(width),
    }


class Fetch(wiring.Component):
    """Entries 0 to ``count - 1`` of a memory over and over, one a cycle.

    The first entry comes `latency` cycles after the end of the flush.

    Parameters
    ----------
    index_bits, width : int
    data_latency : int
        Cycles from ``address`` to ``data``.

    Members
    -------
    flush : In(1)
        Start over; held while idle.
    count : In
        Entries of the list, at least 1; constant while entries are read.
    address : Out, data : In
        To the memory.
    entry : Out(ListEntry), advances : In(1)
        The next entry. With ``advances`` it is taken, if there is one, and the one after it follows.
    second_word : Out
        ``entry.word`` in the next cycle, if it ``advances`` and there is an entry then.
    """

    def __init__(self, *, index_bits: int, width: int, data_latency: int = READ_LATENCY):
        self._data_latency = data_latency
        self.kind = f"fetch_{width}"
        super().__init__({**members(index_bits, width), "advances": In(1)})

    def elaborate(self, platform):
        m, found = Module(), self.entry
        depth = 1 << (self._data_latency + 3).bit_length()  # enough for an entry a cycle
        entry = Cat(found.word, found.last, found.index)
        m.submodules.queue = queue = Queue(width=len(entry), depth=depth)
        with m.If(self.advances):
            m.d.sync += [entry.eq(queue.data), found.valid.eq(queue.valid)]
        with m.If(self.flush):
            m.d.sync += found.valid.eq(0)
        pending = Signal(range(depth + 1), name="pending")  # entries asked for and not taken, as known a cycle later
        taken = Signal(name="taken")
        ask = Signal(name="ask")
        m.d.comb += ask.eq((pending != depth) & ~self.flush)
        last = Signal()
        last_index = Signal(len(self.address))
        m.d.sync += last_index.eq(self.count - 1)
        m.d.comb += last.eq(self.address == last_index)
        with m.If(self.flush):
            m.d.sync += [self.address.eq(0), pending.eq(0), taken.eq(0)]
        with m.Else():
            m.d.sync += [taken.eq(self.advances & found.valid), pending.eq(pending + ask - taken)]
            with m.If(ask):
                m.d.sync += self.address.eq(self.address + 1)
                with m.If(last):
                    m.d.sync += self.address.eq(0)

        tag, arrived = Cat(last, self.address), ask
        for k in range(self._data_latency):
            tag_next = Signal(len(tag), name=f"tag_{k}")
            arrived_next = Signal(name=f"arrived_{k}")
            m.d.sync += [tag_next.eq(tag), arrived_next.eq(arrived & ~self.flush)]
            tag, arrived = tag_next, arrived_next
        m.d.comb += [
            queue.flush.eq(self.flush),
            queue.put.eq(arrived),
            queue.data_in.eq(Cat(self.data, tag)),
            queue.take.eq(self.advances & queue.valid),
            self.second_word.eq(queue.data[: len(found.word)]),
        ]
        return m


class PacedFetch(wiring.Component):
    """A `Fetch` with an issue register of its own, which tells it when its entry moves into the list's issue registers:
    the register drives the whole queue, so it should be placed near it.

    Members
    -------
    ready, next_ready : In(1)
        As in `hw.machine.interfaces.Advance`.
    advance : Out(Advance)
        For the list's issue registers.
    flush, count, address, data, entry, second_word
        As in `Fetch`.
    """

    def __init__(self, *, index_bits: int, width: int, data_latency: int = READ_LATENCY):
        self._sizes = {"index_bits": index_bits, "width": width, "data_latency": data_latency}
        self.kind = f"paced_fetch_{width}"
        ready = {"ready": In(1), "next_ready": In(1), "advance": Out(Advance())}
        super().__init__({**members(index_bits, width), **ready})

    def elaborate(self, platform):
        m = Module()
        m.submodules.fetch = fetch = Fetch(**self._sizes)
        m.submodules.pace = pace = IssueRegister(width=1)
        wiring.connect(m, fetch.entry, wiring.flipped(self.entry))
        wiring.connect(m, self.advance, pace.advance)
        m.d.comb += [
            fetch.flush.eq(self.flush),
            fetch.count.eq(self.count),
            self.address.eq(fetch.address),
            fetch.data.eq(self.data),
            self.second_word.eq(fetch.second_word),
            self.advance.next_valid.eq(fetch.entry.valid),
            self.advance.next_ready.eq(self.next_ready),
            self.advance.ready.eq(self.ready),
            pace.flush.eq(self.flush),
            fetch.advances.eq(pace.advances),
        ]
        return m
