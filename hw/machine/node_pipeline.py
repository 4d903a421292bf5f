"""The part that all node updaters share: the pipeline of `golden.datapath.node.node` and the memories of its words."""

from dataclasses import dataclass

from amaranth.hdl import Cat, Module, Signal, Value
from amaranth.lib.wiring import In, Out

from golden.datapath import records
from golden.numbers.graph import AXES
from hw.blocks.memory import READ_LATENCY, BlockRam
from hw.machine.interfaces import NodeSums, NodeUpdate, StageBits, UpdaterAccess, named
from hw.machine.memory_ports import Use, registered_ports
from hw.machine.node_copies import NODE_WORDS
from hw.machine.node_datapath import NodeDatapath
from hw.machine.routes import HANDOVER, PORT
from hw.parameters import Parameters
from hw.pipeline.delay import DelayLines
from hw.pipeline.operations import shape
from hw.pipeline.pipe import Pipe

RESULTS = {"x_base": "x", "v_base": "v", "v": "v", "x_total": "x_total", "v_total": "v_total"}
"""The results that become a node's next words; a base is written in a step's last stage."""

NEAR = 1
"""Registers from a memory to the pipeline, for a word that is needed late enough: block RAMs sit at fixed sites."""


def members(p: Parameters, datapath: NodeDatapath) -> dict:
    """Return the ports of a node updater."""
    fmt = p.formats
    return {
        "valid": In(1),
        "row": In(p.node_row_bits),
        "mask": In(datapath.banks),
        "stage": In(StageBits()),
        "velocity_shift": In(shape(fmt.exponent)),
        "sums": In(NodeSums(fmt)).array(p.lanes),
        "update": Out(NodeUpdate(fmt)),
        "update_row": Out(p.node_row_bits),
        "fault": Out(len(datapath.faults)),
        "host": In(UpdaterAccess(p)),
    }


def banks(sums) -> list[dict[str, Value]]:
    """Return the sums on a node by axis, in the order of the bits of its mask: first ends of all lanes, then second
    ends."""
    return [named(lane.i) for lane in sums] + [named(lane.j) for lane in sums]


@dataclass(frozen=True)
class Item:
    """An item of the pipeline, one a cycle: a node, or one of its axes.

    ``valid`` and ``last``, the item after which its node is done; its node's ``row`` and its own index in the memories
    of vectors, ``address``; the bits of its ``stage``; and the cycles from all of these to its sums, ``gathered``.
    """

    valid: Value
    last: Value
    row: Value
    address: Value
    stage: dict[str, Value]
    gathered: int


class NodePipeline:
    """Pipeline and memories, written into an updater's module; `build` ends it.

    Parameters
    ----------
    m : Module
    lines : DelayLines
    updater
        The component, with the ports `members`, its ``parameters`` and its ``datapath``.
    item : Item
    carried : dict of str to tuple of str
        The node's axes by the component of the pipeline that carries them, in their order.
    depth : int
        Words of a memory of vectors.
    host_address : Value
        The index of the host's word in the memories of vectors, when it reaches their ports.
    """

    def __init__(self, m: Module, lines: DelayLines, updater, item: Item, carried, depth: int, host_address: Value):
        self._m, self._lines, self._item, self._carried, self._depth = m, lines, item, carried, depth
        self._updater, self._datapath, self._host_address = updater, updater.datapath, host_address
        self._formats, self._arrival = updater.parameters.formats, updater.datapath.schedule.arrival
        host = updater.host
        self._active, self._data = self.by_host(host.active), self.by_host(host.data)
        self._index = self.by_host(host.index)

    def build(self, inputs: dict[str, Value]):
        """Add pipeline and memories to the module. ``inputs`` are the pipeline's sums of forces, and further inputs
        that only some updaters have."""
        m, updater = self._m, self._updater
        inputs = inputs | {"velocity_shift": self._lines.later(updater.velocity_shift, 1)}
        for bit, value in self._item.stage.items():
            inputs[f"stage_{bit}"] = self.later(value, self._arrival[f"stage_{bit}"])
        vectors, loads = self._states(inputs), self._loads(inputs)
        self._masses(inputs)
        pipe = Pipe(m, self._datapath.schedule, inputs, self.later(self._item.valid, 0))
        self._write_states(pipe, vectors)
        forces = self._forces(pipe)
        self._update(pipe)
        states, words = named(updater.host.words.state), updater.host.words
        for component, axes in self._carried.items():
            for axis in axes:
                m.d.comb += [
                    states[f"x_{axis}"].eq(vectors[f"x_base_{component}"].data),
                    states[f"v_{axis}"].eq(vectors[f"v_base_{component}"].data),
                    named(words.load)[axis].eq(loads[component].data),
                    named(words.force)[axis].eq(forces[component].data),
                ]
        m.d.comb += updater.fault.eq(Cat(pipe.faults[name] for name in self._datapath.faults))
        pipe.build()

    def later(self, value: Value, cycle: int) -> Value:
        """Return a value of the item when that is in ``cycle`` of the pipeline."""
        resets = value is self._item.valid or value is self._item.last
        return self._lines.later(value, self._item.gathered + cycle, reset=resets)

    def by_host(self, value: Value) -> Value:
        """Return a value of the host in the cycle before it is at a memory's ports."""
        return self._lines.later(value, HANDOVER - PORT, reset=True)

    def _states(self, inputs) -> dict[str, BlockRam]:
        rams = {}
        for quantity, q in records.node_state(self._formats).items():
            for component in self._carried:
                name = f"{quantity}_{component}"
                rams[name] = self._memory(f"node_{name}", q.width, self._arrival[name])
                inputs[name] = self._near(name, rams[name], q)
        return rams

    def _loads(self, inputs) -> dict[str, BlockRam]:
        rams, q = {}, self._formats.accumulator
        strobes = dict(zip(AXES, self.by_host(self._updater.host.write.load), strict=True))
        for component, axes in self._carried.items():
            name = f"load_{component}"
            rams[component] = ram = self._memory(name, q.width, self._arrival[name])
            inputs[name] = self._near(name, ram, q)
            self._write(name, ram, by_host=(_any(strobes[axis] for axis in axes), self._data))
        return rams

    def _masses(self, inputs):
        record, host = records.inverse_mass(self._formats), self._updater.host
        for part, q in record.items():
            name = f"inverse_mass_{part}"
            ram = self._memory(name, q.width, self._arrival[name], vector=False)
            inputs[name] = self._near(name, ram, q)
            word = record.field(part, self._data)
            self._write(name, ram, vector=False, by_host=(self.by_host(host.write.mass), word))
            self._m.d.comb += record.field(part, host.words.mass).eq(ram.data)

    def _forces(self, pipe) -> dict[str, BlockRam]:
        rams, done = {}, self._datapath.done
        for component in self._carried:
            name = f"force_{component}"
            rams[component] = force = BlockRam(width=self._formats.state, depth=self._depth)
            self._m.submodules[name] = force
            self._write(name, force, own=(self.later(self._item.valid, done), pipe.output(name, done)))
            registered_ports(self._m, force, name, self._active, Use(address=self._host_address), Use())
        return rams

    def _write_states(self, pipe, rams):
        done, stage = self._datapath.done, self._item.stage
        valid, last = self.later(self._item.valid, done), self.later(stage["last"], done)
        strobes = dict(zip(NODE_WORDS, self.by_host(self._updater.host.write.state), strict=True))
        for quantity, result in RESULTS.items():
            for component, axes in self._carried.items():
                by_host = None
                if quantity in ("x_base", "v_base", "v"):
                    by_host = _any(strobes[f"{quantity[0]}_{axis}"] for axis in axes), self._data
                own = valid & last if "base" in quantity else valid, pipe.output(f"{result}_{component}", done)
                name = f"{quantity}_{component}"
                self._write(f"node_{name}", rams[name], own=own, by_host=by_host)

    def _update(self, pipe):
        """Drive ``update`` with a node's new state, in the cycle of the last of its axes."""
        updater, done = self._updater, self._datapath.done
        words = named(updater.update)
        for component, axes in self._carried.items():
            for waits, axis in enumerate(reversed(axes)):
                for quantity in "xv":
                    value = pipe.output(f"{quantity}_{component}", done + waits)
                    self._m.d.comb += words[f"{quantity}_{axis}"].eq(value)
        self._m.d.comb += [
            updater.update.strobe.eq(self.later(self._item.last, done)),
            updater.update_row.eq(self.later(self._item.row, done)),
        ]

    def _memory(self, name: str, width: int, arrival: int, *, vector: bool = True) -> BlockRam:
        """Return a memory of a word per node, or per item for a vector, read in time for ``arrival`` or by the host."""
        p = self._updater.parameters
        ram = BlockRam(width=width, depth=self._depth if vector else p.node_rows)
        self._m.submodules[name] = ram
        index, host = (self._item.address, self._host_address) if vector else (self._item.row, self._index)
        address = self.later(index, arrival - READ_LATENCY - PORT - self._early(arrival))
        registered_ports(self._m, ram, name, self._active, Use(address=host), Use(address=address))
        return ram

    def _write(self, name: str, ram: BlockRam, *, vector: bool = True, by_host=None, own=None):
        """Connect a memory's write port: ``by_host`` and ``own`` are (strobe, word) of the host and of the pipeline."""
        host_address = self._host_address if vector else self._index
        own_address = self.later(self._item.address, self._datapath.done)
        uses = [
            Use() if writer is None else Use(write=writer[0], write_address=address, write_data=writer[1])
            for writer, address in ((by_host, host_address), (own, own_address))
        ]
        registered_ports(self._m, ram, name, self._active, *uses)

    def _near(self, name: str, ram: BlockRam, q) -> Value:
        """Return a memory's word in the cycle in which the pipeline needs it, from a register if there is time for
        one."""
        word = Signal(shape(q), name=f"near_{name}")
        self._m.d.comb += word.eq(self._lines.later(ram.data, self._early(self._arrival[name]), name=name))
        return word

    def _early(self, arrival: int) -> int:
        """Return the registers between memory and pipeline for a word that is needed then: `NEAR`, if there is time."""
        return NEAR if self._item.gathered + arrival - READ_LATENCY - PORT >= NEAR else 0


def _any(bits) -> Value:
    bits = list(bits)
    return bits[0] if len(bits) == 1 else Cat(*bits).any()
