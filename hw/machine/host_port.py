"""The host port: a memory-mapped view of the machine (`hw.map.memory_map`)."""

from amaranth.hdl import Array, Cat, Const, Module, Mux, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from hw.blocks.memory import READ_LATENCY
from hw.map.control import COUNTERS, REGISTERS, Control, constants
from hw.map.memory_map import ADDRESS, Map, Region
from hw.pipeline.choice import choose
from hw.pipeline.delay import DelayLines

CHOICE = 2
"""Cycles for choosing a word, then a lane, then a region."""

HANDOVER = 3
"""Registers on the host's way to the memories of lanes and updaters, which are far: a run starts so much later."""

MEMORY = 1 + HANDOVER + READ_LATENCY
"""Cycles from an access to its word: the way to the memories, and theirs."""

LATENCY = 5 + MEMORY + 3 * CHOICE
"""Cycles from a request to its answer: request register, four of decoding, the memory, the choices."""


WRITABLE = [register for register, row in REGISTERS.items() if row.writable]
ANYTIME = [register for register, row in REGISTERS.items() if row.while_busy]
"""Control registers that may be written while the machine is busy."""

COUNTS = [register for register, row in REGISTERS.items() if row.least == 1]
"""Control registers into which 0 may not be written."""


def registered_ports(m, ram, name: str, host, by_host: dict, own: dict):
    """The ports of a memory from registers: what the host wants while nothing runs, and the machine's own. A port that
    only one of them needs is that one's in any case."""
    for port in own | by_host:
        wanted = [choice[port] for choice in (by_host, own) if port in choice]
        register = Signal.like(getattr(ram, port), name=f"{name}_{port}_next", reset_less=port != "write")
        m.d.sync += register.eq(Mux(host, *wanted) if len(wanted) == 2 else wanted[0])
        m.d.comb += getattr(ram, port).eq(register)


def host_signature(state: int) -> dict:
    """The members that the host sees, for words of so many bits."""
    return {
        "request": In(1),
        "write": In(1),
        "address": In(ADDRESS.width),
        "write_data": In(state),
        "answer": Out(1),
        "error": Out(1),
        "read_data": Out(state),
    }


class HostPort(wiring.Component):
    """Takes a request per cycle, answers each `LATENCY` cycles later, in order.

    A request out of range, a write to a read-only word, any access to a memory while the machine is busy, and a run of
    nothing are refused: the answer is an error, the refusal is counted, nothing is changed. What may be written while
    it is busy is in `ANYTIME`.

    Members
    -------
    request, write, address, write_data : In
    answer, error, read_data : Out
    index, data, word, lane : Out
        Of the access that is going on, to the memories.
    strobe : Out
        One bit a region: it is a write to that region.
    <region>_word : In
        What the region's memories hold at the access's address, `MEMORY` + 2 `CHOICE` cycles later.
    start, steps, stop : Out
    busy, <counters of `hw.map.control.COUNTERS`>, steps_done, fault : In
    rows, nodes, velocity_shift : Out
    """

    def __init__(self, map: Map, faults: int):
        self._map = map
        p = map.parameters
        state = p.formats.state
        super().__init__(
            {
                **host_signature(state),
                "index": Out(p.index_bits),
                "data": Out(state),
                "word": Out(ADDRESS["word"].width),
                "lane": Out(ADDRESS["lane"].width),
                "strobe": Out(len(Region)),
                **{word_of(region): In(state) for region in Region if region != Region.CONTROL},
                "start": Out(1),
                "steps": Out(32),
                "stop": Out(1),
                "busy": In(1),
                **{name: In(state) for name in COUNTERS.values()},
                "steps_done": In(32),
                "fault": In(faults),
                "rows": Out(p.row_bits + 1),
                "nodes": Out(p.node_bits + 1),
                "velocity_shift": Out(p.formats.exponent.width),
            }
        )

    def elaborate(self, platform):
        m = Module()
        request, write, address, data = self._registered(
            m, "asked", self.request, self.write, self.address, self.write_data
        )
        index, word, lane, region = ADDRESS.unpack(address).values()

        inside, small, some = Signal(len(Region)), self._small_enough(data), data.any()
        for r in Region:
            limits = self._map.depth(r), len(self._map.words(r)), self._map.lanes(r)
            places = zip((index, word, lane), limits, strict=True)
            m.d.comb += inside[r].eq(Cat(place < limit for place, limit in places).all())
        request, write, index, word, lane, region, data, inside, small, some = self._registered(
            m, "compared", request, write, index, word, lane, region, data, inside, small, some
        )
        lawful = [bit & (some | (r not in COUNTS)) for bit, r in zip(small, Control, strict=True)]
        possible = Signal(len(Region))  # at all, were it this region; whether it is so just now is seen later
        for r in Region:
            m.d.comb += possible[r].eq(inside[r] & (~write | self._writable(r, index, word, lawful)))
        request, write, index, word, lane, region, data, possible = self._registered(
            m, "judged", request, write, index, word, lane, region, data, possible
        )
        controls = region == Region.CONTROL
        writes = Cat(controls & write & (index == register) for register in WRITABLE)
        strobes = Cat(write & (region == r) for r in Region)
        anytime = controls & (~write | Cat(index == register for register in ANYTIME).any())
        possible = request & Array(possible)[region]
        request, index, word, lane, region, data, possible, writes, strobes, anytime = self._registered(
            m, "now", request, index, word, lane, region, data, possible, writes, strobes, anytime
        )
        written = Signal(len(writes))  # a control register, a cycle later
        starts, starting = (bits[WRITABLE.index(Control.RUN)] for bits in (writes, written))
        go, loaded = Signal(), Signal(2)  # a count that is written is not 0
        free = ~self.busy & ~self.start & ~starting
        m.d.comb += go.eq(possible & (anytime | free) & (~starts | loaded.all()))
        for bit, register in zip(loaded, (Control.ROW_COUNT, Control.NODE_COUNT), strict=True):
            with m.If(go & writes[WRITABLE.index(register)]):
                m.d.sync += bit.eq(1)

        # The access itself, a cycle later; its word and region wait for the memory
        refused, refuse = Signal(32), Signal()
        m.d.sync += [self.index.eq(index), self.data.eq(data), self.word.eq(word), self.lane.eq(lane)]
        m.d.sync += [self.strobe.eq(Mux(go, strobes, 0)), written.eq(Mux(go, writes, 0))]
        stopping = written[WRITABLE.index(Control.STOP)]
        m.d.sync += [self.start.eq(starting), self.stop.eq(stopping), refuse.eq(request & ~go)]
        m.d.sync += refused.eq(refused + refuse)
        self._control_writes(m, dict(zip(WRITABLE, written, strict=True)), refused)

        lines = DelayLines(m)
        until_chosen = MEMORY + 2 * CHOICE
        register = choose(m, lines, self._registers(refused), self.index, cycles=until_chosen, name="register")
        words = [register, *(getattr(self, word_of(r)) for r in Region if r != Region.CONTROL), Const(0)]
        which = lines.later(Mux(go, region, len(Region)), 1 + until_chosen, name="which")
        for port, value in ((self.answer, request), (self.error, request & ~go)):
            m.d.comb += port.eq(lines.later(value, 1 + until_chosen + CHOICE, name=port.name, reset=True))
        m.d.comb += self.read_data.eq(choose(m, lines, words, which, cycles=CHOICE, name="read"))
        lines.build()
        return m

    def _registered(self, m, stage, *values):
        registers = [Signal.like(value, name=f"{stage}_{number}") for number, value in enumerate(values)]
        m.d.sync += [register.eq(value) for register, value in zip(registers, values, strict=True)]
        return registers

    def _small_enough(self, data):
        """A bit for each control register: whether the data are not too great to be written into it."""
        p = self._map.parameters
        return Cat(data <= row.most(p) if row.most else Const(row.writable) for row in REGISTERS.values())

    def _writable(self, region, index, word, lawful):
        """Whether such a word may be written; a control register, when its data are lawful."""
        if region == Region.NODE:
            words = enumerate(self._map.words(region))
            return ~Cat(word == number for number, name in words if self._map.read_only(region, name)).any()
        if region == Region.CONTROL:
            return Array(lawful)[index[: (len(Control) - 1).bit_length()]]
        return Const(1)

    def _control_writes(self, m, written, refused):
        for register, target in (
            (Control.ROW_COUNT, self.rows),
            (Control.NODE_COUNT, self.nodes),
            (Control.VELOCITY_SHIFT, self.velocity_shift),
            (Control.RUN, self.steps),
        ):
            with m.If(written[register]):
                m.d.sync += target.eq(self.data)
        with m.If(written[Control.REFUSED]):
            m.d.sync += refused.eq(0)
        clear = Mux(written[Control.FAULTS], self.data[: len(self.fault)], 0)
        self._sticky = Signal(len(self.fault), name="sticky_faults")
        m.d.sync += self._sticky.eq(self._sticky & ~clear | self.fault)

    def _registers(self, refused):
        """What a read of each control register gives."""
        p, state = self._map.parameters, len(self.read_data)
        values = {
            **{register: Const(value, state) for register, value in constants(p).items()},
            Control.BUSY: self.busy | self.start,
            **{counter: getattr(self, name) for counter, name in COUNTERS.items()},
            Control.STEPS_DONE: self.steps_done,
            Control.FAULTS: self._sticky,
            Control.REFUSED: refused,
            Control.ROW_COUNT: self.rows,
            Control.NODE_COUNT: self.nodes,
            Control.VELOCITY_SHIFT: self.velocity_shift,
            Control.RUN: Const(0, state),
            Control.STOP: Const(0, state),
        }
        return [values[control] for control in Control]


def word_of(region: Region) -> str:
    """The port for what a region's memories hold."""
    return f"{region.name.lower()}_word"
