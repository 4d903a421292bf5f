"""Block floating point: vectors whose components share one exponent, over any `golden.numbers.number.Number`."""

from golden.numbers.qformat import Q, unsigned


def normalise(vector, operand: int):
    """Return mantissas of ``operand`` bits and the shift they share: ``x = mantissa * 2**-shift``.

    The largest component loses its redundant sign bits (leading zeros, if unsigned). So the exact difference of two
    state words keeps its leading bits, however small it is.
    """
    fmt = vector[0].fmt
    most = fmt.width - operand
    if most <= 0:
        raise ValueError(f"a vector must be wider than its {operand}-bit mantissas, not {fmt.width} bits")
    shift = vector[0].lead(vector, most)
    mantissa = Q(fmt.int_bits, operand - fmt.int_bits, fmt.signed)
    return [x.to(mantissa, left=shift) for x in vector], shift


def leading(x, operand: int):
    """Return the ``operand`` leading bits of a number that is not negative, and their shift: ``x`` is
    ``mantissa * 2**-shift`` but for the bits below the mantissa's LSB."""
    shift = x.lead([x], x.fmt.width - operand)
    return cut(x.to(x.fmt, left=shift), unsigned(x.fmt.int_bits, operand - x.fmt.int_bits)), shift


def magnitude(x, operand: int):
    """Return ``|x|``, its mantissa in [1/2, 1) and the shift: ``|x| = mantissa * 2**(x.fmt.int_bits - 1 - shift)``.

    The mantissa is cut, not rounded, so the operations after it need not wait for a carry. The shift is counted on
    ``x``, so it is known as soon as ``|x|``. Therefore a negative power of two gets a mantissa of 1, which saturates
    to the largest one.
    """
    size, below = abs(x), x.fmt.width - 1 - operand
    shift = x.lead([x], below)
    shifted = size.scale(1 - x.fmt.int_bits).to(unsigned(1, x.fmt.width - 1), left=shift)
    return size, cut(shifted, unsigned(1, operand)).to(unsigned(0, operand)), shift


def cut(x, fmt):
    """Return ``x``, which is in the range of ``fmt``, without the bits below its LSB; this needs no carry."""
    return x.field(x.fmt.frac_bits - fmt.frac_bits, fmt)


def difference(a, b):
    """Return ``a - b``, component by component."""
    return [p - q for p, q in zip(a, b, strict=True)]


def dot(a, b, frac_bits: int):
    """Return the dot product. Its products are cut to ``frac_bits`` fraction bits, which makes the sum narrower."""
    products = [p * q for p, q in zip(a, b, strict=True)]
    fmt = products[0].fmt
    return a[0].total([cut(product, Q(fmt.int_bits, frac_bits, fmt.signed)) for product in products])


def clamp(x, low, high):
    """Return ``x``, or the end of the interval that it is beyond."""
    return (x < low).select(low, (high < x).select(high, x))


def with_sign(negative, magnitude):
    """Return ``-magnitude`` where ``negative`` is 1, else ``magnitude``."""
    return negative.select(0 - magnitude, magnitude)
