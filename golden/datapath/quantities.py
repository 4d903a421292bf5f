"""The named quantities of the datapath: what the equations return, and what the rest of the project knows about it.

Nothing outside `golden.datapath.edge` and `golden.datapath.node` depends on the name of a variable in them: `named`
holds what they return against these tables.
"""

from collections.abc import Iterable
from dataclasses import dataclass


@dataclass(frozen=True)
class Quantity:
    """One named quantity.

    Attributes
    ----------
    name : str
        The name under which an equation returns it; its signals in the Verilog begin with it.
    words : str
        What reports and documentation call it.
    measured : bool
        Whether a run's report shows how much of its format it uses: it has a format of its own, and it is kept for
        long or multiplied.
    normalised : bool
        Whether it is a mantissa that travels with a shift. It fills its bits on purpose, so it has no headroom.
    extra_register_after : bool
        Whether one more register follows its operation: its paths were the longest after routing.
    """

    name: str
    words: str
    measured: bool = False
    normalised: bool = False
    extra_register_after: bool = False


def _measured(name: str, words: str, **properties) -> Quantity:
    return Quantity(name, words, measured=True, **properties)


EDGE = (
    # Geometry
    _measured("d", "edge vector", normalised=True, extra_register_after=True),
    Quantity("d_shift", "shift of the edge vector"),
    Quantity("squared", "squared length, below 1 or not"),
    Quantity("short", "1 if the squared length is below 1"),
    _measured("square", "squared length", normalised=True),
    Quantity("degenerate", "1 if the edge is too short"),
    Quantity("l_shift", "shift of the length"),
    _measured("inverse", "1 / length", normalised=True),
    Quantity("products", "edge vector times 1 / length"),
    _measured("u", "direction of the edge"),
    # Trial force
    _measured("w", "relative velocity", normalised=True),
    Quantity("w_shift", "shift of the relative velocity"),
    _measured("rate", "rate of the length", normalised=True),
    _measured("share", "ratio, as an operand"),
    _measured("relaxed", "length of the Voigt part", extra_register_after=True),
    _measured("stretch", "stretch of the spring", normalised=True, extra_register_after=True),
    Quantity("stretch_shift", "shift of the stretch"),
    _measured("spring", "spring's trial force", extra_register_after=True),
    _measured("dashpot", "damper's trial force"),
    Quantity("trial", "trial force"),
    Quantity("negative", "1 if the trial force is negative"),
    Quantity("size", "magnitude of the trial force, not normalised"),
    _measured("g", "magnitude of the trial force", normalised=True),
    Quantity("g_shift", "shift of the trial force"),
    # Force-dependent damper
    Quantity("octave_fraction", "fraction of an octave"),
    Quantity("octaves", "octaves above the first segment"),
    Quantity("table_position", "segment of the damper table, and fraction of it"),
    Quantity("segment", "segment of the damper table"),
    Quantity("fraction", "fraction of the segment"),
    Quantity("rho_middle", "rho in the middle branch"),
    Quantity("sigma_middle", "sigma in the middle branch"),
    Quantity("below", "1 if the trial force is below the middle branch"),
    Quantity("between", "1 if the trial force is not above the middle branch"),
    _measured("rho", "rho", normalised=True, extra_register_after=True),
    Quantity("rho_shift", "shift of rho"),
    _measured("sigma", "sigma", normalised=True),
    Quantity("sigma_shift", "shift of sigma"),
    # Force
    Quantity("along", "direction of the force"),
    _measured("trials", "trial force along the axes"),
    Quantity("f_shift", "shift of the force"),
    _measured("pull", "force on a node", extra_register_after=True),
    # Ratio
    _measured("s", "sigma g", normalised=True),
    Quantity("s_shift", "shift of sigma g"),
    _measured("creep", "creep rate"),
    _measured("extension", "extension rate"),
    _measured("net", "difference of the two rates", normalised=True),
    Quantity("net_shift", "shift of the difference"),
    _measured("weighted", "1 / length, weighted", normalised=True),
    Quantity("weight_shift", "shift of 1 / length, weighted"),
    Quantity("slope_shift", "shift of the ratio's slope"),
    _measured("slope", "slope of the ratio"),
    Quantity("total", "sum of the ratio's slopes, not rounded"),
    _measured("total_next", "sum of the ratio's slopes"),
    Quantity("value", "ratio, not clamped"),
    _measured("ratio_next", "ratio"),
    Quantity("base_next", "ratio at the start of the step"),
)
"""Quantities of `golden.datapath.edge.edge`, in the order in which reports list them."""

NODE = (
    Quantity("sums", "sum of forces on a node, load included"),
    _measured("force", "sum of forces on a node"),
    _measured("mantissa", "sum of forces, as an operand", normalised=True),
    Quantity("mantissa_shift", "shift of the sum of forces"),
    _measured("factor", "1 / mass, weighted", normalised=True),
    Quantity("factor_shift", "shift of 1 / mass, weighted"),
    Quantity("gain", "sum of forces times 1 / mass"),
    Quantity("gain_shift", "shift of that product"),
    _measured("acceleration", "velocity gained in a step", extra_register_after=True),
    _measured("v_total", "sum of the velocity's slopes"),
    _measured("v", "velocity"),
    Quantity("v_base_next", "velocity at the start of the step"),
    _measured("displacement", "displacement in a step"),
    _measured("x_total", "sum of the displacements"),
    _measured("x", "position"),
    Quantity("x_base_next", "position at the start of the step"),
)
"""Quantities of `golden.datapath.node.node`, in the order in which reports list them."""

QUANTITIES = {quantity.name: quantity for quantity in (*EDGE, *NODE)}


def named(values: dict, table: tuple[Quantity, ...]) -> dict:
    """Return ``values``, what an equation returns, held against the table of its quantities.

    Raises
    ------
    ValueError
        If a name is not in the table, or a quantity of the table is missing.
    """
    known = {quantity.name for quantity in table}
    for name in values:
        if name not in known:
            raise ValueError(f"a quantity must be listed in golden.datapath.quantities, not {name!r}")
    if missing := sorted(known - values.keys()):
        raise ValueError(f"the equations must return every quantity of their table, not all but {', '.join(missing)}")
    return values


def check_known(names: Iterable[str], what: str) -> None:
    """Raise ValueError, naming ``what``, if one of these is not the name of a quantity."""
    for name in names:
        if name not in QUANTITIES:
            raise ValueError(f"{what} must name quantities of golden.datapath.quantities, not {name!r}")


def table() -> str:
    """Return the table of quantities for the documentation, in Markdown."""
    rows = ["| of | name | quantity | normalised |", "|---|---|---|---|"]
    for owner, quantities in (("edge", EDGE), ("node", NODE)):
        rows += [f"| {owner} | {q.name} | {q.words} | {'yes' if q.normalised else ''} |" for q in quantities]
    return "\n".join(rows)
