"""The forces on nodes, summed edge by edge."""

from amaranth.hdl import Cat, Module, Mux, Signal, signed
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from golden.formats import Formats
from golden.graph import AXES

from .blocks.memory import READ_LATENCY, BlockRam

WRITTEN = 2
"""Cycles from a force to the first in which its sum may be read."""


class Accumulator(wiring.Component):
    """One sum per node and axis; a force per cycle, for any order of nodes.

    A sum that is still on its way back to the memory is forwarded, so that the same node may follow itself at once.
    Integer addition is associative: the order changes nothing. Nothing is cleared: the first force on a node in a
    stage replaces what is there.

    A force is announced (``valid``, ``node``, ``first``) `READ_LATENCY` cycles before it comes (``pull_*``). Its sum
    may be read `WRITTEN` cycles after that, `READ_LATENCY` cycles after ``sum_node`` as ``sum_*``.

    Parameters
    ----------
    formats : Formats
    nodes : int
        Capacity.
    subtract : bool
        Whether forces are taken with the opposite sign: the second end of an edge gets the same integers.
    """

    def __init__(self, *, formats: Formats, nodes: int, subtract: bool = False):
        self._nodes, self._subtract = nodes, subtract
        bits = max(1, (nodes - 1).bit_length())
        width = formats.accumulator.width
        self.kind = f"accumulator_{'subtract' if subtract else 'add'}"
        super().__init__(
            {
                "valid": In(1),
                "node": In(bits),
                "first": In(1),
                **{f"pull_{axis}": In(signed(width)) for axis in AXES},
                "sum_node": In(bits),
                **{f"sum_{axis}": Out(signed(width)) for axis in AXES},
            }
        )

    def elaborate(self, platform):
        m = Module()
        # The force under way: k cycles after its announcement
        valid, node, first = [self.valid], [self.node], [self.first]
        for k in range(1, READ_LATENCY + WRITTEN + 1):
            lines = [(valid, "valid"), (node, "node")] + ([(first, "first")] if k <= READ_LATENCY else [])
            for line, name in lines:
                register = Signal.like(line[0], name=f"{name}_{k}", reset_less=name != "valid")
                m.d.sync += register.eq(line[-1])
                line.append(register)

        # At READ_LATENCY it meets its force; a sum of 1, 2 or 3 cycles ago is not in the word that was read
        now, recent = READ_LATENCY, range(1, READ_LATENCY + WRITTEN)
        forward = []
        for age in recent:
            hit = Signal(name=f"forward_{age}")
            m.d.sync += hit.eq(valid[now - 1 + age] & (node[now - 1 + age] == node[now - 1]))
            forward.append(hit)

        for axis in AXES:
            pull, total = getattr(self, f"pull_{axis}"), getattr(self, f"sum_{axis}")
            m.submodules[f"sum_{axis}_edges"] = own = BlockRam(width=len(total), depth=self._nodes)
            m.submodules[f"sum_{axis}_nodes"] = copy = BlockRam(width=len(total), depth=self._nodes)
            sums = [Signal.like(total, name=f"sum_{axis}_{age}", reset_less=True) for age in recent]
            before = Signal.like(total, name=f"before_{axis}")
            m.d.comb += before.eq(own.data)
            for hit, recently in reversed(list(zip(forward, sums, strict=True))):
                with m.If(hit):
                    m.d.comb += before.eq(recently)
            start = Mux(first[now], 0, before)
            m.d.sync += sums[0].eq(start - pull if self._subtract else start + pull)
            m.d.sync += Cat(*sums[1:]).eq(Cat(*sums[:-1]))
            for ram in (own, copy):
                m.d.comb += [
                    ram.write.eq(valid[now + 1]),
                    ram.write_address.eq(node[now + 1]),
                    ram.write_data.eq(sums[0]),
                ]
            m.d.comb += [own.address.eq(self.node), copy.address.eq(self.sum_node), total.eq(copy.data)]
        return m
