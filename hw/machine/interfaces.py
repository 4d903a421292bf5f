"""The interfaces between the machine's components. Directions are those of the side that drives most of an interface;
a component on the other side has it as ``In``. Times are in cycles of the one clock; strobes are high for one cycle
each."""

from amaranth.hdl import Value
from amaranth.lib.wiring import In, Out, Signature

from golden.datapath.formats import Formats
from golden.datapath.rk4 import RK4
from golden.numbers.graph import AXES
from golden.numbers.qformat import Q, unsigned
from hw.map.control import COUNTERS
from hw.map.memory_map import ADDRESS, Region
from hw.parameters import Parameters
from hw.pipeline.operations import shape


def named(interface) -> dict[str, Value]:
    """Return an interface's ports by name, with the names of nested interfaces as prefix."""
    return {"_".join(map(str, path)): port for path, _, port in interface.signature.flatten(interface)}


class Named(Signature):
    """Ports with the names and formats of a graph's inputs or outputs (`golden.numbers.graph.Graph`)."""

    def __init__(self, operations: dict):
        super().__init__({name: Out(shape(operation.fmt)) for name, operation in operations.items()})


class Vector(Signature):
    """The components of a vector, all in one format. They are valid in the same cycle."""

    def __init__(self, q: Q):
        super().__init__({axis: Out(shape(q)) for axis in AXES})


class NodeState(Signature):
    """A node's position (sizes) and velocity (velocity scale), both of the same stage."""

    def __init__(self, position: Q, velocity: Q):
        super().__init__({"x": Out(Vector(position)), "v": Out(Vector(velocity))})


class StageBits(Signature):
    """The bits that tell a datapath its Runge-Kutta stage, as in `golden.datapath.rk4.RK4.stage`. They belong to the
    item that enters in their cycle."""

    def __init__(self):
        super().__init__({bit: Out(1) for bit in RK4.stage(0)})


class NodeUpdate(Signature):
    """A node's new state, from its updater. ``x`` and ``v`` count only while ``strobe`` is high; the node's row comes
    beside, one for all updaters. `hw.machine.routes.COPIED` cycles later every lane's copy has the state."""

    def __init__(self, fmt: Formats):
        super().__init__({"strobe": Out(1), **NodeState(fmt.position, fmt.velocity).members})


class NodeSums(Signature):
    """The forces summed on a node, in a lane: as first ends (``i``) and as second ends (``j``) of its edges. They
    follow their row of nodes by `hw.machine.accumulator.READ` cycles."""

    def __init__(self, fmt: Formats):
        super().__init__({end: Out(Vector(fmt.accumulator)) for end in "ij"})


class Advance(Signature):
    """The bits that move a list's entry from its fetch into each of its issue registers (`hw.machine.issue_register`).

    ``next_valid``: the fetch has an entry. ``next_ready``: were that entry in the register in the next cycle, it could
    be issued then. ``ready``: the entry in the register can be issued in the next cycle. All registers of a list get
    the same three bits in the same cycle, so that they hold the same entry.
    """

    def __init__(self):
        super().__init__({"next_valid": Out(1), "next_ready": Out(1), "ready": Out(1)})


class ListEntry(Signature):
    """An entry of a list, while ``valid``: its word, its index in the list, and whether it is the last one."""

    def __init__(self, index_bits: int, width: int):
        super().__init__({"valid": Out(1), "index": Out(index_bits), "last": Out(1), "word": Out(width)})


class Completion(Signature):
    """One more entry of a list is ``done``, and it is the ``last`` one; ``last`` only with ``done``."""

    def __init__(self):
        super().__init__({"done": Out(1), "last": Out(1)})


class ListControl(Signature):
    """The state of a list, for the sequencer, and the sequencer's answers.

    ``valid``: an entry is in the issue register, ``last``: it is the list's last one, ``issue``: it is issued in this
    cycle. ``reached``: all that it waits for has been done, in the stage in which entries of the other list are done;
    ``next_reached`` and, if asked for, ``next_last``: the same of the entry after it. The answers ``ready`` and
    ``next_ready`` (`Advance`) come in the same cycle.
    """

    def __init__(self, *, next_last: bool = False):
        names = ("valid", "issue", "last", "reached", "next_reached") + ("next_last",) * next_last
        super().__init__({**{name: Out(1) for name in names}, "ready": In(1), "next_ready": In(1)})


class HostAccess(Signature):
    """The host port as a host sees it. While ``request`` is high, ``write``, ``address`` and ``write_data`` are one
    request a cycle. `hw.machine.host_port.LATENCY` cycles after each, in order, ``answer`` is high, with ``error`` if
    the request was refused, and with ``read_data``, 0 if it was."""

    def __init__(self, state: int):
        super().__init__(
            {
                "request": Out(1),
                "write": Out(1),
                "address": Out(ADDRESS.width),
                "write_data": Out(state),
                "answer": In(1),
                "error": In(1),
                "read_data": In(state),
            }
        )


class HostBus(Signature):
    """All ports of the circuit: `HostAccess`, and ``busy`` while steps are run."""

    def __init__(self, state: int):
        super().__init__({**HostAccess(state).members, "busy": In(1)})


class MemoryAccess(Signature):
    """The host port's accesses to memories. In each cycle ``index``, ``word`` and ``lane`` ask for a word; a bit of
    ``strobe``, one for each region, makes the access a write of ``data``. What a region holds there comes in ``words``
    `hw.machine.routes.MEMORY` + 2 `hw.machine.routes.CHOICE` cycles later."""

    def __init__(self, p: Parameters):
        state = p.formats.state
        words = {region.name.lower(): Out(state) for region in Region if region != Region.CONTROL}
        super().__init__(
            {
                "index": Out(p.index_bits),
                "data": Out(state),
                "word": Out(ADDRESS["word"].width),
                "lane": Out(ADDRESS["lane"].width),
                "strobe": Out(len(Region)),
                "words": In(Signature(words)),
            }
        )


class Counters(Signature):
    """The counters of a run (`hw.map.control.COUNTERS`), each as it was two cycles ago."""

    def __init__(self, width: int):
        super().__init__({name: Out(width) for name in COUNTERS.values()})


class EntryAccess(Signature):
    """The host's access to a list's memory: while ``active``, ``word`` is what stands at ``index``; ``write`` writes
    ``data`` there, only while nothing runs."""

    def __init__(self, index_bits: int, width: int):
        super().__init__(
            {
                "active": Out(1),
                "index": Out(index_bits),
                "write": Out(1),
                "data": Out(width),
                "word": In(width),
            }
        )


class LaneAccess(Signature):
    """The host's access to a lane's memories, while ``active`` is high and no edge is under way.

    A strobe in ``write`` writes ``data`` at ``index``: ``node`` has a bit for each word of a node's state, in one array
    element for each updater; ``material`` has one for each of its words, ``table`` for rho and sigma. What the memories
    hold at ``index`` comes in ``words`` `hw.machine.routes.FOUND` cycles later; a material's word number ``field``
    comes `hw.machine.routes.CHOICE` cycles later still.
    """

    def __init__(self, p: Parameters, *, materials: int, table: int):
        state = p.formats.state
        write = {
            "node": Out(2 * len(AXES)).array(p.updates),
            "length": Out(1),
            "ratio": Out(1),
            "material": Out(materials),
            "table": Out(2),
        }
        words = {"length": Out(state), "ratio": Out(state), "material": Out(state), "table": Out(table)}
        super().__init__(
            {
                "active": Out(1),
                "index": Out(p.index_bits),
                "data": Out(state),
                "field": Out(range(materials)),
                "write": Out(Signature(write)),
                "words": In(Signature(words)),
            }
        )


class UpdaterAccess(Signature):
    """The host's access to a node updater's memories, while ``active`` is high and no node is under way.

    A strobe in ``write`` writes ``data`` at ``index``: ``state`` has a bit for each word of a node's state, ``load``
    for each axis. ``axis`` is that of the word, for an updater that takes one axis at a time. What the memories hold at
    ``index`` comes in ``words`` `hw.machine.routes.FOUND` cycles later.
    """

    def __init__(self, p: Parameters):
        state, word = p.formats.state, unsigned(p.formats.state, 0)
        words = {"state": Out(NodeState(word, word)), "load": Out(Vector(word)), "force": Out(Vector(word))}
        write = {"state": Out(2 * len(AXES)), "load": Out(len(AXES)), "mass": Out(1)}
        super().__init__(
            {
                "active": Out(1),
                "index": Out(p.index_bits),
                **({"axis": Out(range(len(AXES)))} if p.cycles_per_node > 1 else {}),
                "data": Out(state),
                "write": Out(Signature(write)),
                "words": In(Signature({**words, "mass": Out(state)})),
            }
        )
