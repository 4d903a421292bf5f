"""A chart of a pipeline in clock cycles: a row for each quantity, with the operations that compute it."""

from dataclasses import dataclass

from hw.docs import svg

COLOURS = {
    "memory": ("#8250df", "memory read or write"),
    "mul": ("#0969da", "multiplier"),
    "shift": ("#bf8700", "leading bits, shifter"),
    "table": ("#1a7f37", "table in block RAM"),
    "sum": ("#6e7781", "carry chain, rounding, choice"),
}
"""By group of operations, its colour and its words in the legend."""

GROUPS = {"mul": "mul", "lead": "shift", "shift_left": "shift", "shift_right": "shift", "read": "table"}
"""By kind of operation, its group, if it isn't a carry chain or a choice."""

CYCLE, ROW, LEFT, TOP = 10, 20, 345, 60


@dataclass(frozen=True)
class Row:
    """A line of the chart.

    Attributes
    ----------
    name, words : str
        The quantity as the equations call it, and in words.
    spans : list of (str, int, int)
        Group, first cycle and end of each operation.
    """

    name: str
    words: str
    spans: list[tuple[str, int, int]]

    @property
    def done(self) -> int:
        """The cycle in which the quantity has its value."""
        return max(end for _, _, end in self.spans)


def rows_of(schedule, quantities: list[tuple[str, str, tuple[str, ...]]], offset: int) -> list[Row]:
    """Return a row for each quantity of a pipeline, its cycles counted from ``offset`` cycles before the pipeline's.

    ``quantities`` are (name, words, stems). An operation belongs to the quantity with the longest stem that its name
    begins with.

    Raises
    ------
    ValueError
        If a quantity has no operation, or an operation no quantity.
    """
    owners = {stem: number for number, (_, _, stems) in enumerate(quantities) for stem in stems}
    spans = [[] for _ in quantities]
    for name, kind, start, end in schedule.stages():
        stems = [stem for stem in owners if name == stem or name.startswith(f"{stem}_")]
        if not stems:
            raise ValueError(f"the operation {name} must belong to a quantity of the chart, but belongs to none")
        span = GROUPS.get(kind, "sum"), start + offset, end + offset
        spans[owners[max(stems, key=len)]].append(span)
    for (name, *_), own in zip(quantities, spans, strict=True):
        if not own:
            raise ValueError(f"the chart's quantity {name} must have operations, but has none")
    return [Row(name, words, sorted(set(own))) for (name, words, _), own in zip(quantities, spans, strict=True)]


def chart(title: str, rows: list[Row], note: str) -> str:
    """Return the picture of ``rows``, from cycle 0 to the last one that is done."""
    last = max(row.done for row in rows)
    width, bottom = LEFT + CYCLE * last + 60, TOP + ROW * len(rows)
    elements = [svg.text(16, 26, title, size=16, bold=True), svg.text(16, 44, note, size=11, fill=svg.FAINT)]
    for cycle in range(0, last + 1, 5):
        x = LEFT + CYCLE * cycle
        elements.append(svg.line(x, TOP, x, bottom, stroke=svg.GRID))
        if cycle % 10 == 0:
            elements += [svg.text(x, y, str(cycle), size=11, anchor="middle") for y in (TOP - 4, bottom + 14)]
    for number, row in enumerate(rows):
        elements += _row(row, TOP + ROW * number)
    return svg.document(width, bottom + 54, title, elements + _legend(bottom + 30))


def _row(row: Row, y: float) -> list[str]:
    start = min(start for _, start, _ in row.spans)
    middle, right = y + ROW / 2, LEFT + CYCLE * row.done
    bars = [
        svg.rect(LEFT + CYCLE * first, y + 4, CYCLE * (end - first), ROW - 8, fill=COLOURS[group][0], stroke="#ffffff")
        for group, first, end in sorted(row.spans, key=lambda span: span[0] != "sum")  # the short ones below the others
        if end > first
    ]
    return [
        svg.text(16, middle + 4, row.name, bold=True),
        svg.text(130, middle + 4, row.words, size=11, fill=svg.FAINT),
        svg.line(LEFT + CYCLE * start, middle, right, middle, stroke=svg.FAINT),
        *bars,
        svg.text(right + 5, middle + 4, str(row.done), size=11),
    ]


def _legend(y: float) -> list[str]:
    elements, x = [], LEFT - 200
    for colour, words in COLOURS.values():
        elements += [svg.rect(x, y, 14, 12, fill=colour), svg.text(x + 19, y + 10, words, size=11)]
        x += 40 + 6.6 * len(words)
    return elements
