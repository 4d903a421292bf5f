"""A list on its way from its memory to the issue of its entries."""

from amaranth.hdl import Cat, Module
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from hw.machine.completion_counter import CompletionCounter
from hw.machine.fetch import PacedFetch
from hw.machine.interfaces import Advance, Completion, ListControl
from hw.machine.issue_register import IssueRegister
from hw.pipeline.delay import DelayLines


class ListIssue(wiring.Component):
    """Fetches a list's entries and issues each as soon as the sequencer lets it.

    Parameters
    ----------
    index_bits, width, data_latency : int
        As in `hw.machine.fetch.PacedFetch`.
    need : slice
        The bits of a word that say how many entries of the other list must be done.
    first : int
        As in `hw.machine.completion_counter.CompletionCounter`.
    latency : int
        Cycles from the issue of an entry to its completion.
    next_last : bool
        As in `hw.machine.interfaces.ListControl`.

    Members
    -------
    flush, clear : In(1)
        Empty the list's registers, before a run; begin to count, with a run.
    count, address, data
        As in `hw.machine.fetch.Fetch`.
    control : Out(ListControl)
    advance : Out(Advance)
        For further issue registers, which hold ``next_word`` and ``next_index`` in part.
    word, index, next_word, next_index : Out
        The entry in the issue register, and the one that is fetched for it.
    others : In(Completion), completion : Out(Completion)
        Entries of the other list as they are done, and those of this list.
    """

    def __init__(self, *, index_bits, width, data_latency, need, first, latency, next_last=False):
        self._fetch = {"index_bits": index_bits, "width": width, "data_latency": data_latency}
        self._need, self._first, self._latency, self._next_last = need, first, latency, next_last
        self.kind = f"list_issue_{width}"
        super().__init__(
            {
                "flush": In(1),
                "clear": In(1),
                "count": In(index_bits + 1),
                "address": Out(index_bits),
                "data": In(width),
                "control": Out(ListControl(next_last=next_last)),
                "advance": Out(Advance()),
                "word": Out(width),
                "index": Out(index_bits),
                "next_word": Out(width),
                "next_index": Out(index_bits),
                "others": In(Completion()),
                "completion": Out(Completion()),
            }
        )

    def elaborate(self, platform):
        m, control, need = Module(), self.control, self._need
        lines = DelayLines(m)
        m.submodules.fetch = fetch = PacedFetch(**self._fetch)
        following = Cat(fetch.entry.word, fetch.entry.last, fetch.entry.index)
        m.submodules.issue_register = issue = IssueRegister(width=len(following))
        wiring.connect(m, fetch.advance, wiring.flipped(self.advance), issue.advance)
        counter = CompletionCounter(width=need.stop - need.start, first=self._first)
        m.submodules.counter = counter
        wiring.connect(m, wiring.flipped(self.others), counter.completion)
        m.d.comb += [
            fetch.flush.eq(self.flush),
            fetch.count.eq(self.count),
            fetch.data.eq(self.data),
            self.address.eq(fetch.address),
            fetch.ready.eq(control.ready),
            fetch.next_ready.eq(control.next_ready),
            issue.flush.eq(self.flush),
            issue.next.eq(following),
            Cat(self.word, control.last, self.index).eq(issue.entry),
            self.next_word.eq(fetch.entry.word),
            self.next_index.eq(fetch.entry.index),
            control.valid.eq(issue.valid),
            control.issue.eq(issue.issue),
            counter.clear.eq(self.clear),
            counter.need.eq(self.word[need]),
            counter.next_need.eq(fetch.entry.word[need]),
            counter.second_need.eq(fetch.second_word[need]),
            counter.advances.eq(issue.advances),
            control.reached.eq(counter.reached),
            control.next_reached.eq(counter.next_reached),
            self.completion.done.eq(lines.later(issue.issue, self._latency, name="done", reset=True)),
        ]
        if self._next_last:
            m.d.comb += control.next_last.eq(fetch.entry.last)
        last = issue.issue & control.last
        m.d.comb += self.completion.last.eq(lines.later(last, self._latency, name="last_done", reset=True))
        lines.build()
        return m
