"""The datapath of an edge: equations (1) to (5) and (7) in step units, over any `golden.numbers.number.Number`.

A block-normalised quantity ``q`` is a mantissa and a shift: its value is ``q * 2**-q_shift``.
"""

from golden.datapath.rk4 import rk4, weigh
from golden.numbers.block import clamp, cut, difference, dot, leading, magnitude, normalise, with_sign
from golden.numbers.qformat import Q


def edge(fmt, tables, stage, velocity_shift, material, i, j, state):
    """Compute one Runge-Kutta stage of one edge between the nodes ``i`` and ``j``.

    Parameters
    ----------
    fmt : golden.datapath.formats.Formats
    tables
        ``inverse(index)`` and ``damper(index)``: the words of `golden.datapath.tables`, as namespaces.
    stage
        Bits ``first``, ``half``, ``double``, ``last`` of `golden.datapath.rk4.Tableau.stage`.
    velocity_shift
        The velocity full scale is ``2**-velocity_shift`` sizes per step.
    material
        The fields of `golden.datapath.records.material`.
    i, j
        Nodes: vectors ``x`` (position) and ``v`` (velocity) of this stage.
    state
        The edge's ``length`` L and its ratio: ``base`` at the start of the step, ``ratio`` in this stage, ``total``
        of the slopes so far.

    Returns
    -------
    dict
        The quantities of `golden.datapath.quantities.EDGE` by name. The outputs are ``pull`` (the force on i; on j it
        is the same integers with the opposite sign), ``base_next``, ``ratio_next`` and ``total_next``.
    """
    span = fmt.position.int_bits
    axis = axis_of(fmt, tables, i.x, j.x)
    u, l_shift, inverse = axis["u"], axis["l_shift"], axis["inverse"]

    # ldot = u . w with w = vj - vi
    w, w_shift = normalise([c.scale(-1) for c in difference(j.v, i.v)], fmt.operand)
    rate = dot(u, w, fmt.dot_frac_bits).to(fmt.rate).scale(1)

    # g = k (a l - L) + c1 ldot
    share = state.ratio.to(fmt.share)
    relaxed = voigt_length(fmt, share, axis)
    (stretch,), stretch_shift = normalise([relaxed - state.length], fmt.operand)
    spring = (material.k * stretch).to(fmt.trial, right=stretch_shift + material.k_shift, cut=True)
    dashpot = (material.c * rate).to(fmt.trial, right=w_shift + material.c_shift, cut=True)
    trial = spring + dashpot
    negative = trial < 0
    size, g, g_shift = magnitude(trial, fmt.operand)

    # rho(|g|) and sigma(|g|): constants outside the middle branch of (7), a table inside
    branch = damper(fmt, tables, material, size, g, g_shift)
    rho, rho_shift, sigma, sigma_shift = branch["rho"], branch["rho_shift"], branch["sigma"], branch["sigma_shift"]

    # f = -rho g along u: g u first, which is ready before rho is
    along = [with_sign(negative, c).to(fmt.direction) for c in u]
    trials = [(g * c).to(fmt.direction) for c in along]
    f_shift = g_shift + rho_shift + material.force_shift
    pull = [(rho * c).to(fmt.force, right=f_shift) for c in trials]

    # adot = ((1 - a) ldot - sigma g) / l
    s = (sigma * g).to(fmt.mantissa)
    s_shift = g_shift + sigma_shift + material.creep_shift
    creep = s.to(fmt.creep, right=s_shift)
    extension = ((1 - share).to(fmt.share) * rate).to(fmt.creep, right=w_shift)
    (net,), net_shift = normalise([negative.select(extension + creep, extension - creep)], fmt.operand)
    weighted, weight_shift = weigh(stage, inverse)
    slope_shift = net_shift + (weight_shift + velocity_shift - l_shift)
    slope = (net * weighted).scale(-span).to(fmt.ratio, right=slope_shift)

    total, value = rk4(stage, state.base, state.total, slope)
    total_next = total.to(fmt.ratio)
    value = value.to(Q(value.fmt.int_bits + 1, fmt.ratio.frac_bits))  # wide enough never to saturate; the clamp follows
    ratio_next = clamp(value, material.a_min, material.a_max).to(fmt.ratio)
    base_next = stage.last.select(ratio_next, state.base)
    return (
        axis
        | {"w": w, "w_shift": w_shift, "rate": rate, "share": share}
        | {"relaxed": relaxed, "stretch": stretch, "stretch_shift": stretch_shift}
        | {"spring": spring, "dashpot": dashpot, "trial": trial, "negative": negative}
        | {"size": size, "g": g, "g_shift": g_shift}
        | branch
        | {"along": along, "trials": trials, "f_shift": f_shift, "pull": pull}
        | {"s": s, "s_shift": s_shift, "creep": creep, "extension": extension, "net": net, "net_shift": net_shift}
        | {"weighted": weighted, "weight_shift": weight_shift, "slope_shift": slope_shift, "slope": slope}
        | {"total": total, "total_next": total_next, "value": value, "ratio_next": ratio_next, "base_next": base_next}
    )


def axis_of(fmt, tables, xi, xj):
    """Return the quantities that follow from the positions: d = xj - xi, ``square`` = l^2, ``inverse`` = 1 / l and
    u = d / l. Lengths are in units of 2^(span - l_shift) sizes."""
    span = fmt.position.int_bits
    d, d_shift = normalise([c.scale(-span) for c in difference(xj, xi)], fmt.operand)
    squared = dot(d, d, fmt.dot_frac_bits)
    short = squared < 1
    silent = fmt.square.nameless  # the branch not taken may saturate; the other can do so only by an LSB
    square = short.select(squared.scale(2).to(silent), squared.to(silent))
    degenerate = square < 1
    degenerate.fault("edge length")
    inverse = interpolate_inverse(fmt, tables, square)
    l_shift = d_shift + short
    products = [c * inverse for c in d]
    u = [short.select(product.scale(1), product).to(fmt.direction) for product in products]
    return {
        "d": d,
        "d_shift": d_shift,
        "squared": squared,
        "short": short,
        "square": square,
        "degenerate": degenerate,
    } | {"l_shift": l_shift, "inverse": inverse, "products": products, "u": u}


def voigt_length(fmt, share, axis):
    """Return a l = a l^2 / l, the length of the Voigt part; a l^2 is ready when 1 / l is. The natural length L is taken
    from this product too, so that rest is exact."""
    weighted, shift = leading(share * axis["square"], fmt.operand)
    product = (weighted * axis["inverse"]).scale(fmt.position.int_bits)
    return product.to(fmt.length, right=axis["l_shift"] + shift, cut=True)


def interpolate_inverse(fmt, tables, square):
    """Return 1 / sqrt(square) for 1 <= square < 4."""
    index = square.field(fmt.inverse_fraction.width, fmt.inverse_index)
    word = tables.inverse(index)
    return cut(word.value - word.slope * square.field(0, fmt.inverse_fraction), fmt.inverse)


def damper(fmt, tables, material, size, g, g_shift):
    """Return rho and sigma, each a mantissa and a shift, at |g| = size, whose mantissa is g."""
    # The position of |g| among the table's segments: octaves, and the fraction of an octave, which is linear in |g|
    octave_fraction = g.field(0, fmt.octave_fraction)
    octaves = octave_fraction - (g_shift + material.first_octave)
    finest = Q(octaves.fmt.int_bits + fmt.fineness.raw_max, fmt.damper_fraction.width)  # loses nothing
    table_position = octaves.to(finest).to(finest, left=material.fineness)  # segment, fraction of it
    segment = table_position.field(finest.frac_bits, fmt.damper_index)
    fraction = table_position.field(0, fmt.damper_fraction)
    word = tables.damper(material.table, segment)
    rho_middle = cut(word.rho_value - word.rho_slope * fraction, fmt.mantissa)
    sigma_middle = cut(word.sigma_value + word.sigma_slope * fraction, fmt.mantissa)

    below, between = size < material.g1, size < material.g2

    def branch(low, middle, high):
        return below.select(low, between.select(middle, high))

    rho = branch(material.rho_low, rho_middle, material.rho_high)
    rho_shift = branch(material.rho_low_shift, word.rho_shift, material.rho_high_shift)
    sigma = branch(material.sigma_low, sigma_middle, material.sigma_high)
    sigma_shift = branch(material.sigma_low_shift, word.sigma_shift, material.sigma_high_shift)
    return (
        {"octave_fraction": octave_fraction, "octaves": octaves}
        | {"table_position": table_position, "segment": segment, "fraction": fraction}
        | {"rho_middle": rho_middle, "sigma_middle": sigma_middle, "below": below, "between": between}
        | {"rho": rho, "rho_shift": rho_shift, "sigma": sigma, "sigma_shift": sigma_shift}
    )
