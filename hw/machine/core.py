"""The coprocessor: lanes, node updaters, sequencer and host port. Connections only."""

from types import SimpleNamespace

from amaranth.hdl import Cat, Module, Mux, Signal, Value
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from golden.datapath import records
from golden.numbers.graph import AXES
from hw.blocks import highest
from hw.machine.access import Access
from hw.machine.completion_counter import CompletionCounter
from hw.machine.edge import EdgeDatapath
from hw.machine.entry_memory import LATENCY as LISTED
from hw.machine.entry_memory import EntryMemory
from hw.machine.fetch import PacedFetch
from hw.machine.host_port import HANDOVER, HostPort, host_signature
from hw.machine.issue_register import IssueRegister
from hw.machine.lane import COPIED, NEXT, NODE_WORDS, STAGED, Lane, latency, written
from hw.machine.sequencer import Sequencer
from hw.machine.updater import NodeDatapath, NodeUpdater
from hw.map.control import COUNTERS
from hw.map.fields import stage_bits
from hw.map.memory_map import Map, Region
from hw.parameters import Parameters
from hw.pipeline.delay import DelayLines


def row_latency(parameters: Parameters) -> int:
    """Cycles from a row's address to its edges and the highest of their nodes."""
    return LISTED + highest.latency(2 * parameters.lanes)


def datapaths(p: Parameters) -> tuple[EdgeDatapath, NodeDatapath]:
    """Of an edge and of a node."""
    return EdgeDatapath(p.formats, p.tables, p.cost), NodeDatapath(p.formats, p.lanes, p.cost, p.cycles_per_node)


def faults(edge: EdgeDatapath, node: NodeDatapath) -> list[str]:
    """Names of the bits of the control register ``FAULTS``."""
    return sorted({*edge.faults, *node.faults})


class Core(wiring.Component):
    """The whole circuit behind its host port (`hw.machine.host_port.host_signature`).

    Parameters
    ----------
    parameters : Parameters
    lane : callable
        Makes a lane from the parameters and the edge's datapath: a `Lane`, or an instance of its Verilog module.

    Attributes
    ----------
    faults : list of str
        Names of the bits of the control register ``FAULTS``.
    """

    def __init__(self, parameters: Parameters, lane=Lane):
        self.parameters, self._make_lane = parameters, lane
        self.datapath, self.node_datapath = datapaths(parameters)
        self.faults = faults(self.datapath, self.node_datapath)
        self._check()
        state = parameters.formats.state
        self._host_members = host_signature(state)
        super().__init__({**self._host_members, "busy": Out(1)})

    def _check(self):
        """An edge's own words must be back before its nodes are: then it may come again, or the run is over."""
        datapath = self.datapath
        loop = latency(datapath) + self.node_datapath.latency + COPIED
        for word, output in NEXT.items():
            if (cycles := written(datapath, output)) > loop:
                raise ValueError(f"the edge's {word} must be written within {loop} cycles, not after {cycles}")

    def elaborate(self, platform):
        m = Module()
        self._m, self._lines, p = m, DelayLines(m), self.parameters
        m.submodules.host = self._host = HostPort(Map(p), len(self.faults))
        m.submodules.sequencer = self._sequencer = Sequencer(cycles_per_node=p.cycles_per_node)
        self._updaters = []
        for number in range(p.updates):
            m.submodules[f"updater{number}"] = updater = NodeUpdater(p, self.node_datapath)
            self._updaters.append(updater)
        self._lanes = []
        for number in range(p.lanes):
            m.submodules[f"lane{number}"] = lane = self._make_lane(p, self.datapath)
            self._lanes.append(lane)

        self._access = Access(m, self._lines, p, self._host)
        # Far from the lanes, which have time for it
        self._velocity_shift = self._lines.later(self._host.velocity_shift, 1, name="velocity_shift")
        self._idle = Signal(init=1)
        m.d.sync += self._idle.eq(~self._sequencer.busy)
        m.d.comb += self.busy.eq(self._sequencer.busy)
        self._loading = Signal(init=1)  # a run has not begun, or not for long enough
        idle = [self._lines.later(self._idle, cycles, name="idle", reset=True) for cycles in range(HANDOVER)]
        m.d.sync += self._loading.eq(Cat(~self._sequencer.busy, *idle).any())
        done = {"row": "row_summed", "node": "node_updated"}  # the forces may be read, the new state has been written
        self._done = {entry: Signal(name=name) for entry, name in done.items()}
        self._done_last = {entry: Signal(name=f"{name}_last") for entry, name in done.items()}
        m.d.comb += [
            self._sequencer.row_summed_last.eq(self._done_last["row"]),
            self._sequencer.node_updated_last.eq(self._done_last["node"]),
        ]
        self._rows()
        self._nodes()
        self._sums()
        self._access.to_nodes(self._updaters, self._node_entries, self._idle)
        self._access.to_lanes(self._lanes, self._edge_entries, self._idle)
        for name, member in self._host_members.items():
            inner, outer = getattr(self._host, name), getattr(self, name)
            m.d.comb += inner.eq(outer) if member.flow == In else outer.eq(inner)
        self._counters()

        fault = Signal(len(self.faults))
        sources = [(self.datapath.faults, lane.fault) for lane in self._lanes]
        sources += [(self.node_datapath.faults, updater.fault) for updater in self._updaters]
        for number, name in enumerate(self.faults):
            bits = [bit[names.index(name)] for names, bit in sources if name in names]
            m.d.sync += fault[number].eq(Cat(*bits).any())
        m.d.comb += self._host.fault.eq(fault)
        self._lines.build()
        return m

    def _entries(self, name, record, depth, fetch_address, host_address, write):
        """A list's memory: what the host does with it is far from it, as for all other memories."""
        self._m.submodules[name] = entries = EntryMemory(width=record.width, depth=depth)

        def far(value, of):
            return self._lines.later(value, HANDOVER - 1, name=f"{name}_{of}", reset=of == "write")

        self._m.d.comb += [
            entries.host.eq(self._loading),
            entries.host_address.eq(far(host_address, "index")),
            entries.fetch_address.eq(fetch_address),
            entries.write.eq(far(write, "write")),
            entries.write_address.eq(far(host_address, "index")),
            entries.write_data.eq(far(self._access.data, "data")),
        ]
        return entries

    def _front(self, name, other, fetch, need, first):
        """The list's entry in front: ``word``, ``last``, ``index``. ``need`` of an entry's word is what waits for the
        other list's `hw.machine.completion_counter`, which counts from ``first``."""
        m, sequencer, behind = self._m, self._sequencer, Cat(fetch.word, fetch.last, fetch.index)
        m.submodules[f"{name}_front"] = front = IssueRegister(width=len(behind))
        words = len(fetch.word)
        entry = SimpleNamespace(word=front.entry[:words], last=front.entry[words], index=front.entry[words + 1 :])
        m.submodules[f"{other}_progress"] = progress = CompletionCounter(width=len(need(fetch.word)), first=first)
        for lane in self._lanes:
            m.d.comb += [
                getattr(lane, f"{name}_behind_valid").eq(fetch.valid),
                getattr(lane, f"{name}_behind_ready").eq(getattr(sequencer, f"{name}_behind_ready")),
                getattr(lane, f"{name}_ready").eq(getattr(sequencer, f"{name}_ready")),
            ]
        m.d.comb += [
            fetch.flush.eq(self._loading),
            front.flush.eq(self._loading),
            front.behind.eq(behind),
            front.behind_valid.eq(fetch.valid),
            front.behind_ready.eq(getattr(sequencer, f"{name}_behind_ready")),
            fetch.behind_ready.eq(getattr(sequencer, f"{name}_behind_ready")),
            fetch.ready.eq(getattr(sequencer, f"{name}_ready")),
            front.ready.eq(getattr(sequencer, f"{name}_ready")),
            getattr(sequencer, f"{name}_valid").eq(front.valid),
            getattr(sequencer, f"{name}_goes").eq(front.goes),
            getattr(sequencer, f"{name}_last").eq(entry.last),
            progress.clear.eq(sequencer.start),
            progress.done.eq(self._done[other]),
            progress.done_last.eq(self._done_last[other]),
            progress.front.eq(need(entry.word)),
            progress.behind.eq(need(fetch.word)),
            progress.after.eq(need(fetch.next_word)),
            progress.moves.eq(front.moves),
            getattr(sequencer, f"{name}_{other}s").eq(progress.front_reached),
            getattr(sequencer, f"{name}_behind_{other}s").eq(progress.behind_reached),
        ]
        cycles = {"row": latency(self.datapath) - 1, "node": self.node_datapath.latency + COPIED}[name]
        for done, value in ((self._done, front.goes), (self._done_last, front.goes & entry.last)):
            m.d.comb += done[name].eq(self._lines.later(value, cycles, name=done[name].name, reset=True))
        return entry

    def _rows(self):
        """A row is an edge for every lane."""
        m, p, host = self._m, self.parameters, self._host
        record = records.edge_entry()
        width = record.width
        m.submodules.row_highest = last = highest.Highest(count=2 * p.lanes, width=p.node_row_bits)
        size = width * p.lanes + p.node_row_bits
        m.submodules.row_fetch = fetch = PacedFetch(index_bits=p.row_bits, width=size, data_latency=row_latency(p))
        words, self._edge_entries = [], []
        for number in range(p.lanes):
            write = self._access.strobe(Region.EDGE, 0, number)
            entries = self._entries(f"edge_entries{number}", record, p.rows, fetch.address, self._access.index, write)
            words.append(entries.entry)
            self._edge_entries.append(entries.data)
        edges = [record.unpack(word) for word in words]
        behind_memory = row_latency(p) - LISTED
        later = [self._lines.later(word, behind_memory, name=f"edge_entry{n}") for n, word in enumerate(words)]
        m.d.comb += [
            last.valid.eq(Cat(edge["valid"].replicate(2) for edge in edges)),
            last.numbers.eq(Cat(p.node_place(edge[end])[0][: p.node_row_bits] for edge in edges for end in "ij")),
            fetch.count.eq(host.rows),
            fetch.data.eq(Cat(*later, last.highest)),
        ]
        front = self._front("row", "node", fetch, lambda word: word[width * p.lanes :], 0)

        entries = [slice(n * width, (n + 1) * width) for n in range(p.lanes)]
        self._valid = [record.field("valid", front.word[entry]) for entry in entries]
        bits = stage_bits(self._sequencer.row_stage)
        stage = {bit: self._lines.later(value, STAGED, name=bit) for bit, value in bits.items()}
        for lane, entry in zip(self._lanes, entries, strict=True):
            m.d.comb += [
                lane.flush.eq(self._loading),
                lane.row_behind.eq(fetch.index),
                lane.edge_behind.eq(fetch.word[entry]),
                *(getattr(lane, bit).eq(value) for bit, value in stage.items()),
                lane.velocity_shift.eq(self._velocity_shift),
            ]

    def _nodes(self):
        """A row of nodes is a node for every updater."""
        m, p, host, sequencer = self._m, self.parameters, self._host, self._sequencer
        record = records.node_entry()
        width = record.width
        m.submodules.node_fetch = fetch = PacedFetch(
            index_bits=p.node_row_bits, width=width * p.updates, data_latency=LISTED
        )
        row, column = p.node_place(self._access.index)
        strobe = self._access.strobe(Region.NODE, Map(p).words(Region.NODE).index("entry"))
        words, self._node_entries = [], []
        for number in range(p.updates):
            write = strobe & (column == number)
            entries = self._entries(f"node_entries{number}", record, p.node_rows, fetch.address, row, write)
            words.append(entries.entry)
            self._node_entries.append(entries.data)
        m.d.comb += [
            fetch.count.eq((host.nodes + (p.updates - 1)) >> p.updates.bit_length() - 1),
            fetch.data.eq(Cat(*words)),
        ]
        # A node needs as many rows, a row the node of that number
        front = self._front("node", "row", fetch, lambda word: record.field("need", word)[: p.row_bits + 1], 1)
        for number, updater in enumerate(self._updaters):
            entry = record.unpack(front.word[number * width : (number + 1) * width])
            m.d.comb += [
                updater.valid.eq(sequencer.node_goes & entry["valid"]),
                updater.row.eq(front.index),
                updater.mask.eq(entry["mask"]),
                updater.velocity_shift.eq(self._velocity_shift),
                *(getattr(updater, bit).eq(value) for bit, value in stage_bits(sequencer.node_stage).items()),
            ]
        m.d.comb += sequencer.node_behind_last.eq(fetch.last)
        for lane in self._lanes:
            m.d.comb += [lane.node_behind.eq(fetch.index), lane.update_row.eq(self._updaters[0].update_row)]
            for number, updater in enumerate(self._updaters):
                m.d.comb += getattr(lane, f"update{number}").eq(updater.update)
                for word in NODE_WORDS:
                    m.d.comb += getattr(lane, f"update{number}_{word}").eq(getattr(updater, f"update_{word}"))

    def _sums(self):
        """First ends of all lanes, then second ends, as in the node entry's mask."""
        for number, lane in enumerate(self._lanes):
            for half, end in enumerate("ij"):
                bank = half * self.parameters.lanes + number
                for n, updater in enumerate(self._updaters):
                    for axis in AXES:
                        total = getattr(lane, f"sum{n}_{end}_{axis}")
                        self._m.d.comb += getattr(updater, f"sum{bank}_{axis}").eq(total)

    def _counters(self):
        m, host, sequencer = self._m, self._host, self._sequencer
        m.d.comb += [
            sequencer.start.eq(host.start),
            sequencer.steps.eq(host.steps),
            sequencer.stop.eq(host.stop),
            host.busy.eq(sequencer.busy),
            host.steps_done.eq(sequencer.steps_done),
        ]
        events = {
            "cycles": sequencer.busy,
            "rows_issued": sequencer.row_goes,
            "edges_issued": Mux(sequencer.row_goes, sum(self._valid), 0),
            **{name: getattr(sequencer, name) for name in ("node_waits", "list_waits", "end_waits")},
        }
        for name in COUNTERS.values():
            counter, event = Signal(len(host.cycles), name=name), Value.cast(events[name])
            counted = Signal.like(event, name=f"{name}_counted")  # a cycle later
            m.d.comb += getattr(host, name).eq(counter)
            m.d.sync += [counted.eq(event), counter.eq(Mux(host.start, 0, counter + counted))]
