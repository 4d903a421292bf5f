"""The picture of a lane: the cycles after an edge's issue in which each of its quantities is computed."""

from hw.blocks.memory import READ_LATENCY
from hw.docs.chart import Row, chart, rows_of
from hw.machine.core import datapaths
from hw.machine.edge_memories import NEXT
from hw.machine.issued import FETCHED
from hw.machine.lane import latency, written
from hw.parameters import Parameters

QUANTITIES = [
    ("d", "xj - xi, normalised to an operand", ("d",)),
    ("square", "l^2 = d . d", ("squared", "square", "short", "degenerate")),
    ("inverse", "1 / l, from a table", ("inverse",)),
    ("u", "d / l, the direction", ("u", "products", "l_shift")),
    ("w", "vj - vi, normalised", ("w",)),
    ("rate", "dl/dt = u . w", ("rate",)),
    ("relaxed", "a l, the Voigt part's length", ("share", "relaxed")),
    ("stretch", "a l - L, normalised", ("stretch",)),
    ("spring", "k (a l - L)", ("spring",)),
    ("dashpot", "c1 dl/dt", ("dashpot",)),
    ("trial", "g = k (a l - L) + c1 dl/dt", ("trial",)),
    ("g", "|g|, normalised, and its sign", ("negative", "size", "g", "below", "between")),
    ("table", "address and word of rho and sigma", ("octaves", "table_position", "sigma_shift_read")),
    ("rho", "c2 / (c1 + c2) at |g|", ("rho_middle", "rho")),
    ("sigma", "1 / (c1 + c2) at |g|", ("sigma_middle", "sigma")),
    ("trials", "g u", ("along", "trials")),
    ("pull", "f = -rho g, along u", ("pull", "f_shift")),
    ("creep", "sigma g", ("s", "creep")),
    ("extension", "(1 - a) dl/dt", ("extension",)),
    ("net", "(1 - a) dl/dt - sigma g", ("net",)),
    ("weighted", "the stage's weight / l", ("weighted",)),
    ("slope", "da/dt", ("slope",)),
    ("ratio", "the stage's and the next step's a", ("value", "total", "ratio_next", "base_next")),
]
"""Name, words, and the stems of the names of its operations (`golden.datapath.edge`), for each row."""


def lane(parameters: Parameters) -> str:
    """Return the picture for a circuit with these parameters, an SVG document."""
    datapath, _ = datapaths(parameters)
    arrival = datapath.schedule.arrival
    last = max(written(datapath, output) for output in NEXT.values())

    def read(word: str, cycles: int) -> tuple[str, int, int]:
        end = FETCHED + arrival.get(word, 0)
        return "memory", end - cycles, end

    own = [read(f"edge_{word}", READ_LATENCY + 1) for word in ("ratio", "length", "total", "base")]
    rows = [
        Row("nodes", "position, then velocity, of both ends", [read(f"i_{word}_x", FETCHED) for word in "xv"]),
        Row("edge", "its ratio, length, total and base", sorted(own, key=lambda span: span[1])),
        *rows_of(datapath.schedule, QUANTITIES, FETCHED),
        Row(
            "sums",
            "the force is in both nodes' sums",
            [("memory", FETCHED + datapath.ready("pull_x"), latency(datapath))],
        ),
        Row("edge", "its next words are in its memories", [("memory", last - 1, last)]),
    ]
    note = (
        "One edge is issued per cycle. A thin line: it waits in delay registers. The number: the cycle when it is done."
    )
    return chart("One edge in a lane: clock cycles after its issue", rows, note)
