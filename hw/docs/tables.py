"""The tables of README.md and docs/ that follow from the code, as Markdown."""

from golden.datapath import formats, quantities
from hw.boards import board as boards
from hw.boards import tables
from hw.boards.result import Build, Timing, published
from hw.emit.latencies import latencies
from hw.map.control import REGISTERS
from hw.map.memory_map import Map, Region
from hw.parameters import Parameters


def format_table(parameters: Parameters) -> str:
    return formats.table(parameters.formats)


def quantity_table(parameters: Parameters) -> str:
    return quantities.table()


def latency_table(parameters: Parameters) -> str:
    lines = ["| part | from, to | cycles |", "|---|---|---|"]
    rows = latencies(parameters)
    return "\n".join(lines + [f"| {part} | {path} | {cycles} |" for part, path, cycles in rows])


def memory_table(parameters: Parameters) -> str:
    memory = Map(parameters)
    lines = ["| region | number | index | words |", "|---|---|---|---|"]
    for region in Region:
        words = "one register each" if region == Region.CONTROL else ", ".join(memory.words(region))
        lines.append(f"| {region.name} | {region.value} | 0 to {memory.depth(region) - 1} | {words} |")
    return "\n".join(lines)


def register_table(parameters: Parameters) -> str:
    lines = ["| index | register | holds |", "|---|---|---|"]
    return "\n".join(lines + [f"| {r.value} | {r.name} | {row.meaning} |" for r, row in REGISTERS.items()])


def timing_table(parameters: Parameters) -> str:
    return tables.markdown(boards.timed(), published(Timing), tables.TIMING)


def build_table(parameters: Parameters) -> str:
    return tables.markdown(boards.names(), published(Build), tables.BUILDS)


def board_table(parameters: Parameters) -> str:
    return tables.markdown(boards.names(), published(Build), tables.SUMMARY)


TABLES = {
    "formats": format_table,
    "quantities": quantity_table,
    "latency": latency_table,
    "memory map": memory_table,
    "registers": register_table,
    "timing": timing_table,
    "builds": build_table,
    "boards": board_table,
}
"""By the name in its markers, the function that makes a table."""
