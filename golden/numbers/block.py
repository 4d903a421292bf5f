"""Vectors that share one exponent, and the arithmetic that goes with them, over any number type."""

from golden.numbers.qformat import Q, unsigned


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


def leading(x, operand: int):
    """The ``operand`` leading bits of ``x``, not negative, and their shift: ``x = mantissa * 2**-shift``, but for what
    is below the last place."""
    shift = x.lead([x], x.fmt.width - operand)
    return cut(x.to(x.fmt, left=shift), unsigned(x.fmt.int_bits, operand - x.fmt.int_bits)), shift


def magnitude(x, operand: int):
    """``|x|``, its mantissa in [1/2, 1) and the shift: ``|x| = mantissa * 2**(x.fmt.int_bits - 1 - shift)``.

    The mantissa has the leading bits as they are, not rounded: what follows needn't wait for a carry. The shift is that
    of ``x``, so that it is known as soon as ``|x|`` is; it makes a power of two below 0 a mantissa of 1, which
    saturates to the one before.
    """
    size, below = abs(x), x.fmt.width - 1 - operand
    shift = x.lead([x], below)
    shifted = size.scale(1 - x.fmt.int_bits).to(unsigned(1, x.fmt.width - 1), left=shift)
    return size, cut(shifted, unsigned(1, operand)).to(unsigned(0, operand)), shift


def cut(x, fmt):
    """``x``, in the range of ``fmt``, without what is below its last place: no carry is awaited."""
    return x.field(x.fmt.frac_bits - fmt.frac_bits, fmt)


def difference(a, b):
    """``a - b``, component by component."""
    return [p - q for p, q in zip(a, b, strict=True)]


def dot(a, b, frac_bits: int):
    """``a . b``, of products that are cut after so many fraction bits: less has to be added."""
    products = [p * q for p, q in zip(a, b, strict=True)]
    fmt = products[0].fmt
    return a[0].total([cut(product, Q(fmt.int_bits, frac_bits, fmt.signed)) for product in products])


def clamp(x, low, high):
    return (x < low).select(low, (high < x).select(high, x))


def with_sign(negative, magnitude):
    """``-magnitude`` where ``negative`` is 1."""
    return negative.select(0 - magnitude, magnitude)
