"""A lane's copies of the nodes' states."""

from amaranth.hdl import Array, Mux, Signal

from golden.numbers.graph import AXES
from hw.blocks.memory import READ_LATENCY, BlockRam
from hw.machine.interfaces import named
from hw.machine.issued import FETCHED, NEAR
from hw.machine.routes import COPIED, HANDOVER

NODE_WORDS = tuple(f"{quantity}_{axis}" for quantity in "xv" for axis in AXES)


def node_copies(m, lines, p, datapath, issued, update_row, updates, host) -> dict:
    """Write the memories into a lane's module: two copies, one for each end of an edge, in a share for each updater.
    Return the edge processor's inputs that are words of nodes.

    A word is read when the edge processor needs it: a node's state stays until all its edges' forces are summed. It is
    in the copies `hw.machine.routes.COPIED` cycles after the update; the last of these registers is shared with the
    host.
    """
    if COPIED < 1:
        raise ValueError(f"COPIED must be at least 1 register, not {COPIED}")

    def by_host(value, name):
        return lines.later(value, HANDOVER - 1, name=name, reset=True)

    active, data = by_host(host.active, "host_active"), by_host(host.data, "host_data")
    host_row, _ = p.node_address(by_host(host.index, "host_index"))
    row = Signal(p.node_row_bits, name="copied_row", reset_less=True)
    m.d.sync += row.eq(Mux(active, host_row, lines.later(update_row, COPIED - 1)))
    strobes, words = [], []
    for n, update in enumerate(updates):
        strobe = lines.later(update.strobe, COPIED - 1, reset=True)
        strobes.append(Signal(len(NODE_WORDS), name=f"copied{n}"))
        host_strobe = by_host(host.write.node[n], f"host_write_node{n}")
        m.d.sync += strobes[n].eq(Mux(active, host_strobe, strobe.replicate(len(NODE_WORDS))))
        state = named(update)
        words.append({})
        for word in NODE_WORDS:
            words[n][word] = Signal.like(state[word], name=f"copied{n}_{word}", reset_less=True)
            m.d.sync += words[n][word].eq(Mux(active, data, lines.later(state[word], COPIED - 1)))

    inputs = {}
    for end in "ij":
        for number, word in enumerate(NODE_WORDS):
            name, found = f"{end}_{word}", []
            read_row, column = p.node_address(issued.at(end, datapath.schedule.arrival.get(name, 0) - FETCHED))
            column = lines.later(column, READ_LATENCY, name=f"{name}_column")
            for n in range(p.updates):
                m.submodules[f"node_{name}_{n}"] = ram = BlockRam(width=len(words[n][word]), depth=p.node_rows)
                m.d.comb += [
                    ram.write.eq(strobes[n][number]),
                    ram.write_address.eq(row),
                    ram.write_data.eq(words[n][word]),
                    ram.address.eq(read_row),
                ]
                found.append(ram.data)
            near = Signal(len(found[0]), name=f"near_{name}", reset_less=True)
            m.d.sync += near.eq(Array(found)[column])
            inputs[name] = lines.later(near, NEAR - 1)
    return inputs
