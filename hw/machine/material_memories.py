"""A lane's memories of material coefficients."""

from golden.datapath import records
from hw.blocks.memory import READ_LATENCY, LutRam
from hw.machine.routes import CHOICE, HANDOVER, MEMORY
from hw.pipeline.choice import choose


def material_memories(m, lines, p, datapath, issued, host) -> dict:
    """Write the memories into a lane's module, a small one for each coefficient, read in the cycle before it is needed.
    Return the edge processor's inputs that are coefficients."""

    def by_host(value, name):
        return lines.later(value, HANDOVER, name=name, reset=True)

    active, write = by_host(host.active, "host_active"), by_host(host.write.material, "host_write_material")
    index, data = by_host(host.index, "host_index"), by_host(host.data, "host_data")
    inputs = {}
    for number, (coefficient, q) in enumerate(records.material(p.formats, p.tables).items()):
        name = f"material_{coefficient}"
        m.submodules[name] = ram = LutRam(width=q.width, depth=p.materials)
        m.d.comb += [
            ram.address.eq(issued.at("material", datapath.schedule.arrival[name] - 1)),
            ram.write.eq(write[number]),
            ram.write_address.eq(index),
            ram.write_data.eq(data),
        ]
        with m.If(active):
            m.d.comb += ram.address.eq(index)
        inputs[name] = ram.data
    word = choose(
        m,
        lines,
        list(inputs.values()),
        host.field,
        cycles=READ_LATENCY - 1 + CHOICE,  # a small memory is quicker than a block RAM, but there are many
        name="material_word",
        ahead=MEMORY - READ_LATENCY + 1,
    )
    m.d.comb += host.words.material.eq(word)
    return inputs
