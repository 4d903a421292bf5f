"""An edge on its way through a lane, from its issue."""

from golden.datapath import records
from hw.blocks.memory import READ_LATENCY
from hw.machine.issue_register import IssueRegister
from hw.parameters import Parameters
from hw.pipeline.delay import DelayLines

NEAR = 1
"""Registers from a node's memory to the edge processor, after the choice of an updater's share."""

FETCHED = READ_LATENCY + NEAR
"""Cycles from the issue of an edge to its nodes at the edge processor."""


class IssuedEdge:
    """The fields of the edge that is issued (`golden.datapath.records.edge_entry`), its ``row``, and whether it is
    ``valid``, each delayed to the cycle in which it is used."""

    def __init__(self, lines: DelayLines, p: Parameters, register: IssueRegister):
        entry = records.edge_entry()
        fields = entry.unpack(register.entry[: entry.width])
        self._lines = lines
        self._fields = fields | {
            "valid": fields["valid"] & register.issue,
            "row": register.entry[entry.width :],
            "i": fields["i"][: p.node_bits],
            "j": fields["j"][: p.node_bits],
            "material": fields["material"][: p.material_bits],
        }

    def at(self, name: str, cycle: int):
        """Return a field when its edge is in ``cycle`` of the edge processor; from -`FETCHED`, its issue, on."""
        return self._lines.later(self._fields[name], FETCHED + cycle, name=name, reset=name == "valid")
