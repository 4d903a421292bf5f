"""The table of a comparison on the terminal."""

from __future__ import annotations

from sim.results.comparison import power, shortcomings

HEAD = "scene", "dim", "nodes", "edges", "steps", "rtl=fixed", "max dx", "allowed", "max da", "saturated", "s", ""


def print_table(entries: list[dict]) -> None:
    """Print one line a scene, below 100 columns unless a scene has a very long name."""
    rows = [HEAD]
    for e in entries:
        rows.append(
            (
                e["scene"],
                *(str(e[key]) for key in ("dim", "nodes", "edges", "steps")),
                {True: "yes", False: "NO", None: "-"}[e["rtl_equals_fixed"]],
                power(e["max_dx_rel"]),
                power(e["bound"]),
                power(e["max_da"]),
                str(e["saturations"]),
                f"{e['seconds']:.0f}",
                "FAILS" if shortcomings(e) else "passes",
            )
        )
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lanes = sorted({e["lanes"] for e in entries if e["lanes"]})
    with_lanes = f"circuit with {' or '.join(map(str, lanes))} lane{'s' * (lanes != [1])}" if lanes else "circuit"
    print(
        f"{with_lanes} against integer model (rtl=fixed: every bit of every frame), integer model\n"
        "against float64 (max dx: largest position difference / size of the object; max da: of a ratio)\n"
    )
    for row in rows:
        print("  ".join([row[0].ljust(widths[0]), *map(str.rjust, row[1:], widths[1:])]).rstrip())
