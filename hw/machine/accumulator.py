"""The forces on nodes, summed edge by edge."""

import functools
import operator

from amaranth.hdl import Cat, Module, Mux, Signal, Value, signed
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from golden.datapath.formats import Formats
from golden.numbers.graph import AXES
from hw.blocks.memory import READ_LATENCY, BlockRam
from hw.machine.interfaces import Vector, named
from hw.parameters import node_address
from hw.pipeline.delay import DelayLines

ANNOUNCED = READ_LATENCY + 1
"""Cycles from the announcement of a force to the force; a register follows the block RAM, as everywhere."""

WRITTEN = 2
"""Cycles from a force to the first in which its sum can be read: a register for the sum, then the memory."""

READ = READ_LATENCY + 1
"""Cycles from a row of nodes to the sums on it, which leave from registers: their routes are long."""


class Accumulator(wiring.Component):
    """One sum per node and axis; a force per cycle, for any order of nodes.

    A sum that is still on its way back to the memory is forwarded, so that the same node may follow itself at once.
    Integer addition is associative: the order changes nothing. Nothing is cleared: the first force on a node in a
    stage replaces what is there.

    A force is announced (``valid``, ``node``, ``first``) `ANNOUNCED` cycles before it comes (``pull``). Its sum can be
    read `WRITTEN` cycles after that: `READ` cycles after ``sum_row``, ``sums`` are those on the nodes of that row.

    Parameters
    ----------
    formats : Formats
    nodes, updates : int
        Capacity; nodes in a row of nodes, a power of two.
    subtract : bool
        Forces are taken with the opposite sign: the second end of an edge gets the same integers.

    Members
    -------
    reset : In(1)
        The circuit's reset, from a register near by; it clears the announcements that are under way.
    valid : In(1), node : In, first : In(1)
    pull : In(Vector)
    sum_row : In, sums : Out(Vector) for each updater

    Raises
    ------
    ValueError
        If a constant is too small: an announcement must leave time to read, a sum to be registered and written.
    """

    def __init__(self, *, formats: Formats, nodes: int, updates: int = 1, subtract: bool = False):
        self._nodes, self._updates, self._subtract = nodes, updates, subtract
        for name, value, least in (
            ("ANNOUNCED", ANNOUNCED, READ_LATENCY + 1),
            ("WRITTEN", WRITTEN, 2),
            ("READ", READ, READ_LATENCY),
        ):
            if value < least:
                raise ValueError(f"{name} must be at least {least} cycles, not {value}")
        bits = max(1, (nodes - 1).bit_length())
        self._rows = -(-nodes // updates)
        self._width = formats.accumulator.width
        self.kind = f"accumulator_{'subtract' if subtract else 'add'}"
        super().__init__(
            {
                "reset": In(1),
                "valid": In(1),
                "node": In(bits),
                "first": In(1),
                "pull": In(Vector(formats.accumulator)),
                "sum_row": In(max(1, (self._rows - 1).bit_length())),
                "sums": Out(Vector(formats.accumulator)).array(updates),
            }
        )

    def elaborate(self, platform):
        m = Module()
        # The force under way: k cycles after its announcement
        now, written = ANNOUNCED, ANNOUNCED + WRITTEN - 1
        recent = range(1, READ_LATENCY + WRITTEN + 1)  # ages of sums that the word that was read lacks
        longest = max(written, now - 3 + recent[-1])
        valid = self._line(m, self.valid, "valid", longest, reset=self.reset)
        node, first = self._line(m, self.node, "node", longest), self._line(m, self.first, "first", now - 2)

        # At ANNOUNCED it meets its force. The latest of the recent sums on the same node counts, which is found before;
        # all but the sum of the cycle before are already there
        same = [Signal(name=f"same_{age}", reset_less=True) for age in recent]
        for age, bit in zip(recent, same, strict=True):
            m.d.sync += bit.eq(valid[now - 3 + age] & (node[now - 3 + age] == node[now - 3]))
        hits = [Signal(name=f"hit_{age}", reset_less=True) for age in recent]
        stored, latest = (Signal(name=f"use_{name}", reset_less=True) for name in ("stored", "latest"))
        for number, hit in enumerate(hits):
            m.d.sync += hit.eq(~first[now - 2] & same[number] & ~Cat(same[:number]).any())
        m.d.sync += [stored.eq(~first[now - 2] & ~Cat(same).any()), latest.eq(hits[0])]

        lines, pulls, sums = DelayLines(m), named(self.pull), [named(total) for total in self.sums]
        for axis in AXES:
            own = self._memory(m, f"sum_{axis}_edges", self._nodes, node[now - READ_LATENCY - 1])
            # Sums of 1 cycle ago and more
            past = [Signal(signed(self._width), name=f"sum_{axis}_{age}", reset_less=True) for age in recent[:-1]]
            earlier = Signal(signed(self._width), name=f"earlier_{axis}", reset_less=True)
            m.d.sync += earlier.eq(_chosen([(stored, own.data), *zip(hits[1:], past, strict=True)]))
            before = Signal(signed(self._width), name=f"before_{axis}")
            m.d.comb += before.eq(_chosen([(latest, past[0])]) | earlier)
            m.d.sync += past[0].eq(before - pulls[axis] if self._subtract else before + pulls[axis])
            m.d.sync += Cat(*past[1:]).eq(Cat(*past[:-1]))
            row, column = node_address(node[written], self._updates)
            _write(m, own, valid[written], node[written], past[WRITTEN - 2])
            for n in range(self._updates):
                copy = self._memory(m, f"sum_{axis}_nodes{n}", self._rows, self.sum_row)
                _write(m, copy, valid[written] & (column == n), row, past[WRITTEN - 2])
                word = lines.later(copy.data, READ - READ_LATENCY, name=f"sum_{axis}_read{n}")
                m.d.comb += sums[n][axis].eq(word)
        lines.build()
        return m

    def _line(self, m, value, name, cycles, *, reset=None) -> list:
        """Return the value 0 to ``cycles`` cycles later; ``reset`` clears its registers."""
        line = [value]
        for k in range(1, cycles + 1):
            register = Signal.like(value, name=f"{name}_{k}", reset_less=True)
            m.d.sync += register.eq(line[-1] if reset is None else Mux(reset, 0, line[-1]))
            line.append(register)
        return line

    def _memory(self, m, name, depth, address) -> BlockRam:
        m.submodules[name] = ram = BlockRam(width=self._width, depth=depth)
        m.d.comb += ram.address.eq(address)
        return ram


def _write(m, ram: BlockRam, strobe, address, word):
    m.d.comb += [ram.write.eq(strobe), ram.write_address.eq(address), ram.write_data.eq(word)]


def _chosen(choices) -> Value:
    """Return the one word whose bit is 1, or 0."""
    return functools.reduce(operator.or_, (Mux(bit, word, 0) for bit, word in choices))
