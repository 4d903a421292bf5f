"""Vectors that share one exponent, and the arithmetic that goes with them, over any number type."""

from .qformat import Q


def normalise(vector, operand: int):
    """The mantissas of ``vector``, ``operand`` bits wide, and the shift they share: ``x = mantissa * 2**-shift``.

    The largest component loses its redundant sign bits (leading zeros, when unsigned); the exact difference of two
    state words thus keeps its leading bits, however small it is.
    """
    fmt = vector[0].fmt
    most = fmt.width - operand
    if most <= 0:
        raise ValueError(f"a vector must be wider than its {operand}-bit mantissas, not {fmt.width} bits")
    shift = vector[0].lead(vector, most)
    mantissa = Q(fmt.int_bits, operand - fmt.int_bits, fmt.signed)
    return [x.to(mantissa, left=shift) for x in vector], shift



def difference(a, b):
    """``a - b``, component by component."""
    return [p - q for p, q in zip(a, b, strict=True)]


def dot(a, b):
    return total_of([p * q for p, q in zip(a, b, strict=True)])


def total_of(terms):
    """The sum, as a tree: its depth is what it costs in time."""
    terms = list(terms)
    while len(terms) > 1:
        pairs = [a + b for a, b in zip(terms[::2], terms[1::2], strict=False)]
        terms = pairs + terms[len(pairs) * 2 :]
    return terms[0]


def clamp(x, low, high):
    return (x < low).select(low, (high < x).select(high, x))


def with_sign(negative, magnitude):
    """``-magnitude`` where ``negative`` is 1."""
    return negative.select(0 - magnitude, magnitude)
