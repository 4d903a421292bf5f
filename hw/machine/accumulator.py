"""The forces on nodes, summed edge by edge."""

import functools
import operator

from amaranth.hdl import Cat, Module, Mux, Signal, Value, signed
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from golden.datapath.formats import Formats
from golden.numbers.graph import AXES
from hw.blocks.memory import READ_LATENCY, BlockRam
from hw.parameters import node_place

ANNOUNCED = READ_LATENCY + 1
"""Cycles from the announcement of a force to the force: a register behind the block RAM, whose place is given."""

WRITTEN = 2
"""Cycles from a force to the first in which its sum may be read."""

READ = READ_LATENCY + 1
"""Cycles from a row of nodes to the sums on it: they have a long way to go, from a register."""


class Accumulator(wiring.Component):
    """One sum per node and axis; a force per cycle, for any order of nodes.

    A sum that is still on its way back to the memory is forwarded, so that the same node may follow itself at once.
    Integer addition is associative: the order changes nothing. Nothing is cleared: the first force on a node in a
    stage replaces what is there.

    A force is announced (``valid``, ``node``, ``first``) `ANNOUNCED` cycles before it comes (``pull_*``). Its sum may
    be read `WRITTEN` cycles after that, `READ` cycles after ``sum_row`` as ``sum<n>_*``: the sums on the ``updates``
    nodes of a row of nodes.

    Parameters
    ----------
    formats : Formats
    nodes, updates : int
        Capacity; nodes in a row of nodes, a power of two.
    subtract : bool
        Whether forces are taken with the opposite sign: the second end of an edge gets the same integers.
    """

    def __init__(self, *, formats: Formats, nodes: int, updates: int = 1, subtract: bool = False):
        self._nodes, self._updates, self._subtract = nodes, updates, subtract
        bits = max(1, (nodes - 1).bit_length())
        self._rows = -(-nodes // updates)
        width = formats.accumulator.width
        self.kind = f"accumulator_{'subtract' if subtract else 'add'}"
        super().__init__(
            {
                "valid": In(1),
                "node": In(bits),
                "first": In(1),
                **{f"pull_{axis}": In(signed(width)) for axis in AXES},
                "sum_row": In(max(1, (self._rows - 1).bit_length())),
                **{f"sum{n}_{axis}": Out(signed(width)) for n in range(updates) for axis in AXES},
            }
        )

    def elaborate(self, platform):
        m = Module()
        # The force under way: k cycles after its announcement
        valid, node, first = [self.valid], [self.node], [self.first]
        for k in range(1, ANNOUNCED + WRITTEN):
            lines = [(valid, "valid"), (node, "node")] + ([(first, "first")] if k < ANNOUNCED - 1 else [])
            for line, name in lines:
                register = Signal.like(line[0], name=f"{name}_{k}", reset_less=name != "valid")
                m.d.sync += register.eq(line[-1])
                line.append(register)

        # At ANNOUNCED it meets its force. A sum of 1 to 4 cycles ago is not in the word that was read: the latest of
        # them counts. Which it is, is found out before; all but that of 1 cycle ago are already there a cycle before
        now, recent = ANNOUNCED, range(1, ANNOUNCED + WRITTEN)
        same = [Signal(name=f"same_{age}", reset_less=True) for age in recent]
        for age, bit in zip(recent, same, strict=True):
            m.d.sync += bit.eq(valid[now - 3 + age] & (node[now - 3 + age] == node[now - 3]))
        hits = [Signal(name=f"hit_{age}", reset_less=True) for age in recent]
        stored, latest = Signal(reset_less=True), Signal(reset_less=True)
        for number, hit in enumerate(hits):
            m.d.sync += hit.eq(~first[now - 2] & same[number] & ~Cat(same[:number]).any())
        m.d.sync += [stored.eq(~first[now - 2] & ~Cat(same).any()), latest.eq(hits[0])]

        for axis in AXES:
            pull, width = getattr(self, f"pull_{axis}"), len(getattr(self, f"sum0_{axis}"))
            m.submodules[f"sum_{axis}_edges"] = own = BlockRam(width=width, depth=self._nodes)
            # Of 1 to 3 cycles ago
            sums = [Signal(signed(width), name=f"sum_{axis}_{age}", reset_less=True) for age in recent[:-1]]
            earlier = Signal(signed(width), name=f"earlier_{axis}", reset_less=True)
            m.d.sync += earlier.eq(_chosen([(stored, own.data), *zip(hits[1:], sums, strict=True)]))
            before = Signal(signed(width), name=f"before_{axis}")
            m.d.comb += before.eq(_chosen([(latest, sums[0])]) | earlier)
            m.d.sync += sums[0].eq(before - pull if self._subtract else before + pull)
            m.d.sync += Cat(*sums[1:]).eq(Cat(*sums[:-1]))
            where = node[now + 1]
            m.d.comb += [
                own.write.eq(valid[now + 1]),
                own.write_address.eq(where),
                own.write_data.eq(sums[0]),
                own.address.eq(self.node),
            ]
            row, column = node_place(where, self._updates)
            for n in range(self._updates):
                m.submodules[f"sum_{axis}_nodes{n}"] = copy = BlockRam(width=width, depth=self._rows)
                m.d.comb += [
                    copy.write.eq(valid[now + 1] & (column == n)),
                    copy.write_address.eq(row),
                    copy.write_data.eq(sums[0]),
                    copy.address.eq(self.sum_row),
                ]
                m.d.sync += getattr(self, f"sum{n}_{axis}").eq(copy.data)
        return m


def _chosen(choices) -> Value:
    """The one word whose bit is 1, or 0."""
    return functools.reduce(operator.or_, (Mux(bit, word, 0) for bit, word in choices))
