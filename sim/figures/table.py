"""The readings of the figures, on the terminal."""

from __future__ import annotations

from sim.results.comparison import power

HEAD = "scene", "quantity", "circuit", "expected", "against", "difference", "allowed", ""


def print_readings(entries: dict[str, dict]) -> None:
    """Print one line for each reading, each once: lengths in mm, differences over the number or the size."""
    rows = [HEAD]
    for read in (read for entry in entries.values() for read in entry["readings"]):
        values = (
            f"{round(1e3 * read[key], 4) + 0:.4f} mm" if read["unit"] == "m" else power(read[key])
            for key in ("circuit", "expected")
        )
        rows.append(
            (
                read["scene"],
                read["quantity"],
                *values,
                read["against"],
                power(read["difference"]),
                power(read["bound"]),
                "passes" if read["passes"] else "FAILS",
            )
        )
    rows = list(dict.fromkeys(rows))
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    for row in rows:
        cells = [*map(str.ljust, row[:2], widths), *map(str.rjust, row[2:], widths[2:])]
        print("  ".join(cells).rstrip())
