"""The datapath of a node: Newton's law and one Runge-Kutta stage, over any `golden.numbers.number.Number`."""

from golden.datapath.rk4 import rk4, rk4_early, weigh
from golden.numbers.block import normalise


def node(fmt, stage, velocity_shift, pulls, load, inverse_mass, state):
    """Compute one Runge-Kutta stage of one node.

    Parameters
    ----------
    fmt, stage, velocity_shift
        As for `golden.datapath.edge.edge`.
    pulls
        Vectors: the sums of edge forces, one for each accumulator.
    load
        Vector: gravity and external force.
    inverse_mass
        Mantissa ``value`` and ``shift`` of m_ref / m; a node that is fixed or driven has 0.
    state
        Vectors ``x_base``, ``v_base`` at the start of the step, ``v`` of this stage, ``x_total``, ``v_total`` of the
        slopes so far.

    Returns
    -------
    dict
        The quantities of `golden.datapath.quantities.NODE` by name. The outputs are ``force``, ``x``, ``v`` (for the
        next stage), ``x_base_next``, ``v_base_next``, ``x_total`` and ``v_total``.
    """
    whole_force = fmt.accumulator + fmt.accumulator  # all pulls together still fit an accumulator
    sums = [load[0].total(terms).to(whole_force) for terms in zip(*pulls, load, strict=True)]
    force = [c.to(fmt.accumulator) for c in sums]
    span = whole_force.int_bits - 1
    mantissa, shift = normalise([c.scale(-span) for c in sums], fmt.operand)
    factor, factor_shift = weigh(stage, inverse_mass.value)
    slope_shift = shift + (factor_shift + inverse_mass.shift)
    products = [(factor * c).scale(span + 1 - fmt.accumulator.int_bits) for c in mantissa]
    acceleration = [c.to(fmt.velocity, right=slope_shift) for c in products]
    displacement = [c.to(fmt.displacement, right=velocity_shift) for c in state.v]

    x, x_base_next, x_total = advance(
        stage, rk4_early, state.x_base, state.x_total, displacement, fmt.position, fmt.displacement
    )
    v, v_base_next, v_total = advance(stage, rk4, state.v_base, state.v_total, acceleration, fmt.velocity, fmt.velocity)
    return (
        {"sums": sums, "force": force, "mantissa": mantissa, "mantissa_shift": shift}
        | {"factor": factor, "factor_shift": factor_shift, "gain": products, "gain_shift": slope_shift}
        | {"acceleration": acceleration, "v_total": v_total, "v": v, "v_base_next": v_base_next}
        | {"displacement": displacement, "x_total": x_total, "x": x, "x_base_next": x_base_next}
    )


def advance(stage, rule, base, total, slope, value_format, total_format):
    """Apply one of the rules of `golden.datapath.rk4` to a vector; return (value, base, total) of the next stage."""
    steps = [rule(stage, *component) for component in zip(base, total, slope, strict=True)]
    totals = [total.to(total_format) for total, _ in steps]
    values = [value.to(value_format) for _, value in steps]
    bases = [stage.last.select(value, start) for value, start in zip(values, base, strict=True)]
    return values, bases, totals
