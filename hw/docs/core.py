"""The picture of the core: the loop from an edge's issue to its issue in the next stage, with its cycles."""

from hw.docs import svg
from hw.emit.latencies import latencies
from hw.machine.accumulator import WRITTEN
from hw.machine.core import datapaths
from hw.machine.issued import FETCHED
from hw.machine.latency import Latencies
from hw.machine.node_datapath import GATHERED
from hw.machine.routes import COPIED
from hw.parameters import Parameters

LANE, NODE, HOST = ("#eaf2fb", "#0969da"), ("#fff6dd", "#bf8700"), ("#f6f8fa", "#57606a")


def loop(parameters: Parameters) -> dict[str, int]:
    """Return the cycles of each part of the loop from an edge's issue to its issue in the next stage."""
    edge, node = datapaths(parameters)
    whole = Latencies.of(parameters)
    summed = FETCHED + edge.ready("pull_x") + WRITTEN
    return {
        "nodes read": FETCHED,
        "edge": edge.ready("pull_x"),
        "force summed": WRITTEN,
        "node may go": whole.edge - summed,
        "sums gathered": GATHERED,
        "node": node.latency - GATHERED,
        "node copied": COPIED,
        "edge may go": whole.node - node.latency - COPIED,
    }


def core(parameters: Parameters) -> str:
    """Return the picture of a circuit with these parameters, an SVG document."""
    p, cycles = parameters, loop(parameters)
    words = {(part, path): number for part, path, number in latencies(p)}
    lanes, updaters = (f"{n} {name}{'s' * (n > 1)}" for n, name in ((p.lanes, "lane"), (p.updates, "updater")))
    way = " + ".join(map(str, cycles.values()))
    caption = f"{way} = {sum(cycles.values())} cycles at least from the issue of an edge to its issue in the next stage"
    elements = [
        svg.text(16, 28, "The core in clock cycles", size=16, bold=True),
        svg.text(16, 46, caption, size=12, fill=svg.FAINT),
        svg.rect(250, 66, 690, 238, fill="none", stroke=LANE[1], round=8),
        svg.text(264, 86, f"{lanes}, each with", fill=LANE[1], bold=True),
        *_box(20, 100, LANE, "edge issue", "a row: one edge", "for each lane"),
        *_box(270, 100, LANE, "node copies", "x, v of all nodes,", "for either end"),
        *_box(520, 100, LANE, "edge processor", f"{cycles['edge']} cycles,", "an edge per cycle"),
        *_box(770, 100, LANE, "accumulators", "forces on first ends", "and on second ends"),
        *_box(520, 216, LANE, "edge memories", "length, ratio,", "base, total"),
        *_box(770, 360, NODE, "node issue", "a row: one node", "for each updater"),
        *_box(520, 360, NODE, updaters, f"{cycles['node']} cycles,", "own state in memories"),
        *_box(
            20, 360, HOST, "host port", f"{words['host port', 'request to answer']} cycles from", "request to answer"
        ),
        svg.arrow((170, 120), (270, 120)),
        *_label(220, 112, cycles["nodes read"], "x, v read", below=132),
        svg.arrow((420, 135), (520, 135)),
        svg.arrow((670, 135), (770, 135)),
        *_label(720, 127, cycles["force summed"], "added", below=149),
        svg.arrow((855, 172), (855, 360)),
        *_beside(862, 325, cycles["node may go"], "row summed"),
        svg.arrow((770, 395), (670, 395)),
        *_label(720, 387, cycles["sums gathered"], "sums read", below=409),
        svg.arrow((520, 395), (345, 395), (345, 172)),
        *_label(432, 387, cycles["node copied"], "new state to all lanes", below=409),
        svg.arrow((270, 156), (170, 156)),
        *_label(220, 150, cycles["edge may go"], "updated", below=169),
        svg.arrow((570, 216), (570, 172)),
        svg.text(563, 198, "read when needed", size=11, fill=svg.FAINT, anchor="end"),
        svg.arrow((620, 172), (620, 216)),
        *_beside(627, 198, words["edge", "issue to its new ratio in the memory"], "after issue"),
        svg.arrow((95, 360), (95, 260), (250, 260)),
        svg.text(103, 282, "every memory, while no", size=11, fill=svg.FAINT),
        svg.text(103, 296, "step is computed", size=11, fill=svg.FAINT),
    ]
    return svg.document(980, 450, "The core in clock cycles", elements)


def _box(x: float, y: float, colours: tuple[str, str], title: str, *words: str) -> list[str]:
    """A box of 150 by 72 with a title and two lines."""
    fill, stroke = colours
    lines = [svg.text(x + 75, y + 43 + 16 * n, line, size=11, anchor="middle") for n, line in enumerate(words)]
    title = svg.text(x + 75, y + 23, title, size=13, anchor="middle", bold=True)
    return [svg.rect(x, y, 150, 72, fill=fill, stroke=stroke, round=5), title, *lines]


def _label(x: float, y: float, cycles: int, words: str, below: float) -> list[str]:
    """A number above a horizontal arrow, with what happens in these cycles below it."""
    number = svg.text(x, y, str(cycles), size=14, anchor="middle", bold=True)
    return [number, svg.text(x, below, words, size=11, fill=svg.FAINT, anchor="middle")]


def _beside(x: float, y: float, cycles: int, words: str) -> list[str]:
    """A number to the right of a vertical arrow, followed by what happens in these cycles."""
    return [svg.text(x, y, str(cycles), size=14, bold=True), svg.text(x + 22, y, words, size=11, fill=svg.FAINT)]
