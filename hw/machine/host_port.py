"""The host port: a memory-mapped view of the machine (`hw.map.memory_map`)."""

from types import SimpleNamespace

from amaranth.hdl import Array, Cat, Const, Module, Mux, Signal, Value
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from hw.machine.control_registers import ANYTIME, COUNTS, WRITABLE, in_range, reads
from hw.machine.interfaces import Counters, HostBus, MemoryAccess, named
from hw.machine.routes import CHOICE, MEMORY
from hw.map.control import Control
from hw.map.memory_map import ADDRESS, Map, Region
from hw.pipeline.choice import choose
from hw.pipeline.delay import DelayLines

STAGES = "receive", "range", "check", "decode", "access"
"""The registers from a request to its access, named after the work that ends in them."""

LATENCY = len(STAGES) + MEMORY + 3 * CHOICE
"""Cycles from a request to its answer."""


class HostPort(wiring.Component):
    """Takes a request per cycle, answers each `LATENCY` cycles later, in order.

    A request out of range, a write to a read-only word, any access to a memory while the machine is busy, and a run of
    nothing are refused: the answer is an error, the refusal is counted, nothing is changed. What may be written while
    it is busy is in `hw.machine.control_registers.ANYTIME`.

    Members
    -------
    bus : In(HostBus)
    memories : Out(MemoryAccess)
    start, steps, stop : Out
        As `hw.machine.sequencer.Sequencer` takes them.
    busy, counters : In(Counters), steps_done, fault : In
    rows, nodes, velocity_shift : Out
        Control registers.

    Raises
    ------
    ValueError
        If `STAGES` names more or fewer registers than there are.
    """

    def __init__(self, map: Map, faults: int):
        self._map = map
        p = map.parameters
        state = p.formats.state
        super().__init__(
            {
                "bus": In(HostBus(state)),
                "memories": Out(MemoryAccess(p)),
                "start": Out(1),
                "steps": Out(32),
                "stop": Out(1),
                "busy": In(1),
                "counters": In(Counters(state)),
                "steps_done": In(32),
                "fault": In(faults),
                "rows": Out(p.row_bits + 1),
                "nodes": Out(p.node_bits + 1),
                "velocity_shift": Out(p.formats.exponent.width),
            }
        )

    def elaborate(self, platform):
        m, memories = Module(), self.memories
        decoded = self._decoded(m)
        written = Signal(len(decoded.writes), name="written")  # a control register, a cycle later
        run = WRITABLE.index(Control.RUN)
        # A count that was accepted is not 0
        accepted = Signal()
        counts_written = Signal(2)
        free = ~self.busy & ~self.start & ~written[run]
        may_run = ~decoded.writes[run] | counts_written.all()
        m.d.comb += accepted.eq(decoded.accepted & (decoded.anytime | free) & may_run)
        for bit, register in zip(counts_written, (Control.ROW_COUNT, Control.NODE_COUNT), strict=True):
            with m.If(accepted & decoded.writes[WRITABLE.index(register)]):
                m.d.sync += bit.eq(1)

        refuse = Signal(name="refuse")
        m.d.sync += [
            memories.index.eq(decoded.index),
            memories.data.eq(decoded.data),
            memories.word.eq(decoded.word),
            memories.lane.eq(decoded.lane),
            memories.strobe.eq(Mux(accepted, decoded.strobes, 0)),
            written.eq(Mux(accepted, decoded.writes, 0)),
            self.start.eq(written[run]),
            self.stop.eq(written[WRITABLE.index(Control.STOP)]),
            refuse.eq(decoded.request & ~accepted),
        ]
        registers = reads(m, self, self._map.parameters, dict(zip(WRITABLE, written, strict=True)), refuse)
        self._answer(m, decoded, accepted, registers)
        return m

    def _decoded(self, m) -> SimpleNamespace:
        """Return a request with everything that is decoded before its access."""
        stages, map_ = iter(STAGES), self._map
        bus = self.bus
        received = _registered(
            m, next(stages), request=bus.request, write=bus.write, address=bus.address, data=bus.write_data
        )
        parts = ADDRESS.unpack(received.address)
        inside = Signal(len(Region), name="inside_region")
        for r in Region:
            limits = {"index": map_.depth(r), "word": len(map_.words(r)), "lane": map_.lanes(r)}
            m.d.comb += inside[r].eq(Cat(parts[part] < limit for part, limit in limits.items()).all())
        ranged = _registered(
            m,
            next(stages),
            request=received.request,
            write=received.write,
            **parts,
            data=received.data,
            inside=inside,
            in_range=in_range(map_.parameters, received.data),
            not_zero=received.data.any(),
        )
        value_ok = [
            bit & (ranged.not_zero | (register not in COUNTS))
            for bit, register in zip(ranged.in_range, Control, strict=True)
        ]
        accepted = Signal(len(Region), name="accepted_in_region")  # busy is checked later
        for r in Region:
            writable = self._writable(r, ranged.index, ranged.word, value_ok)
            m.d.comb += accepted[r].eq(ranged.inside[r] & (~ranged.write | writable))
        checked = _registered(
            m,
            next(stages),
            request=ranged.request,
            write=ranged.write,
            index=ranged.index,
            word=ranged.word,
            lane=ranged.lane,
            region=ranged.region,
            data=ranged.data,
            accepted=accepted,
        )
        controls = checked.region == Region.CONTROL
        anytime = Cat(checked.index == register for register in ANYTIME).any()
        decoded = _registered(
            m,
            next(stages),
            request=checked.request,
            index=checked.index,
            word=checked.word,
            lane=checked.lane,
            region=checked.region,
            data=checked.data,
            accepted=checked.request & Array(checked.accepted)[checked.region],
            writes=Cat(controls & checked.write & (checked.index == register) for register in WRITABLE),
            strobes=Cat(checked.write & (checked.region == r) for r in Region),
            anytime=controls & (~checked.write | anytime),
        )
        if (left := list(stages)) != ["access"]:
            raise ValueError(f"the last of a host port's stages must be the access, not {left}")
        return decoded

    def _writable(self, region, index, word, value_ok) -> Value:
        """Return 1 if the word can be written; a control register, if the value can be."""
        if region == Region.NODE:
            words = enumerate(self._map.words(region))
            return ~Cat(word == number for number, name in words if self._map.read_only(region, name)).any()
        if region == Region.CONTROL:
            return Array(value_ok)[index[: (len(Control) - 1).bit_length()]]
        return Const(1)

    def _answer(self, m, decoded, accepted, registers):
        lines, bus, words = DelayLines(m), self.bus, named(self.memories.words)
        until_chosen = MEMORY + 2 * CHOICE
        register = choose(m, lines, registers, self.memories.index, cycles=until_chosen, name="register")
        words = [register, *(words[r.name.lower()] for r in Region if r != Region.CONTROL), Const(0)]
        region = lines.later(Mux(accepted, decoded.region, len(Region)), 1 + until_chosen, name="answer_region")
        for port, value, name in (
            (bus.answer, decoded.request, "answer"),
            (bus.error, decoded.request & ~accepted, "error"),
        ):
            m.d.comb += port.eq(lines.later(value, 1 + until_chosen + CHOICE, name=name, reset=True))
        m.d.comb += bus.read_data.eq(choose(m, lines, words, region, cycles=CHOICE, name="read"))
        m.d.comb += bus.busy.eq(self.busy)
        lines.build()


def _registered(m: Module, stage: str, **values: Value) -> SimpleNamespace:
    """Return registers for these values, named after the stage and the value."""
    registers = {name: Signal.like(value, name=f"{stage}_{name}") for name, value in values.items()}
    m.d.sync += [registers[name].eq(value) for name, value in values.items()]
    return SimpleNamespace(**registers)
