"""The operations of `golden.numbers.graph` as combinational steps; `hw.pipeline.pipe` puts registers between them.

Each function takes ``wire``, an operation of the graph and the values of its operands. It yields a tuple of values
after each step, the result first. A register may follow each step: the next step is sent what the one before yielded,
registered or not. ``wire(value)`` gives a value that is used more than once a signal of its own, so that the Verilog
says it once; ``wire.shifted(x, times, places, left=)`` is a `hw.blocks.shifter.ShiftStage`.
"""

import functools
import itertools
import operator

from amaranth.hdl import Cat, Const, Mux, Shape, Value

from golden.numbers.qformat import Q


def shape(q: Q) -> Shape:
    """Return the shape of a format's integers."""
    return Shape(q.width, q.signed)


def negative(x: Value) -> Value:
    """Return 1 if ``x`` is negative."""
    return x[-1] if x.shape().signed else Const(0)


def either(bit: Value, yes: Value, no: Value) -> Value:
    """Return ``Mux(bit, yes, no)``, or just ``no`` if the bit is the constant 0."""
    return no if never(bit) else Mux(bit, yes, no)


def never(bit: Value) -> bool:
    """Return whether a bit is the constant 0."""
    return isinstance(bit, Const) and not bit.value


def aligned(*operands):
    """Return values whose LSBs have the same weight, from (value, format) pairs."""
    frac = max(q.frac_bits for _, q in operands)
    return [value << frac - q.frac_bits for value, q in operands]


def _pair(operation, a, b):
    first, second = operation.operands[-2:]
    return aligned((a, first.fmt), (b, second.fmt))


def add(wire, operation, a, b):
    x, y = _pair(operation, a, b)
    yield (x + y,)


def total(wire, operation, *terms):
    """Add three terms at a time: synthesis makes one carry chain of them."""
    terms = aligned(*((x, operand.fmt) for x, operand in zip(terms, operation.operands, strict=True)))
    while len(terms) > 3:
        terms = yield tuple(wire(sum(terms[first : first + 3])) for first in range(0, len(terms), 3))
    yield (sum(terms),)


def sub(wire, operation, a, b):
    x, y = _pair(operation, a, b)
    yield (x - y,)


def less(wire, operation, a, b):
    x, y = _pair(operation, a, b)
    yield (x < y,)


def select(wire, operation, bit, yes, no):
    x, y = _pair(operation, yes, no)
    yield (Mux(bit, x, y),)


def absolute(wire, operation, a):
    yield (Mux(negative(a), -a, a),)


def lead(wire, operation, *vector):
    """Count the leading zeros of the OR of all magnitudes: first which groups of bits are 0, then within a group."""
    magnitude = Const(0)
    for x in vector:
        magnitude |= size(x)
    magnitude = wire(magnitude)[-operation.detail :]
    groups = [slice(max(0, low), low + GROUP) for low in range(operation.detail - GROUP, -GROUP, -GROUP)]
    magnitude, some = yield magnitude, Cat(magnitude[group].any() for group in groups)
    yield (_leading_zeros([(bit, magnitude[group]) for bit, group in zip(some, groups, strict=True)]),)


def size(x: Value) -> Value:
    """Return bits with as many leading zeros as the magnitude of ``x``: a negative number is inverted."""
    return (x[:-1] ^ x[-1].replicate(len(x) - 1)) if x.shape().signed else x


GROUP = 4
"""Bits whose leading zeros are counted together."""


def _leading_zeros(groups) -> Value:
    """Count the leading zeros of (some bit is 1, bits) groups, highest group first, as a tree: the count of the upper
    half, or, if that is 0, its width and the count of the lower half."""
    if len(groups) == 1:
        ((_, bits),) = groups
        zeros = Const(len(bits))
        for number, bit in enumerate(bits):
            zeros = Mux(bit, len(bits) - 1 - number, zeros)
        return zeros
    half = 1 << (len(groups) - 1).bit_length() - 1
    upper, lower = groups[:half], groups[half:]
    some = Cat(bit for bit, _ in upper).any()
    return Mux(some, _leading_zeros(upper), half * GROUP + _leading_zeros(lower))


def shift_left(wire, operation, x, count):
    """Shift to the left; the bits lost at the top are redundant (`lead`)."""
    low = len(count) // 4 * 2
    x = _shifted(wire, x, count, low, left=True)
    x, count = yield x, count[:low]
    yield (_shifted(wire, x, count, left=True),)


def _shifted(wire, x, count, low=0, *, left):
    """Shift by bits ``low`` and up of the count, two bits at a time."""
    stages = [slice(max(low, bit - 2), bit) for bit in range(len(count), low, -2)]
    for bits in stages:
        x = wire.shifted(x, count[bits], 1 << bits.start, left=left)
    return x


def round_half_up(wire, operation, x):
    """Round to the format's fraction bits and saturate. The second value is the fault."""
    source, target = operation.operands[0].fmt, operation.fmt
    drop = source.frac_bits - target.frac_bits
    if drop <= 0:
        value = x << -drop
        yield _saturate(target, value, value)
    else:
        yield _saturate(target, wire((x + (1 << drop - 1)) >> drop), x >> drop)


def shift_right(wire, operation, x, count):
    """Round, or cut, and saturate ``x * 2**-count``; ``count`` comes from `shift_count`. The second value is the
    fault."""
    target = operation.fmt
    drop = max(0, operation.operands[0].fmt.frac_bits - target.frac_bits)
    x = x << _grown(operation)
    some = left = below = Const(0)
    if operation.operands[1].fmt.signed:
        some, left, below = Cat(x[low : low + 8].any() for low in range(0, len(x), 8)), count[-1], negative(x)
    count = count[:-1]
    low = len(count) // 4 * 2
    x = _shifted(wire, x, count, low, left=False)
    x, count, some, left, below = yield x, count[:low], some, left, below
    beyond = some if never(some) else left & some.any()
    x = _shifted(wire, x, count, left=False)
    x, beyond, below = yield x >> drop, beyond, below
    floor = x >> _rounding_bits(operation)
    result, fault = _saturate(target, floor if operation.detail == "cut" else wire((x + 1) >> 1), floor)
    extreme = either(below, Const(target.raw_min, shape(target)), Const(target.raw_max, shape(target)))
    yield either(beyond, extreme, result), fault if never(beyond) else fault | beyond


def shift_count(operation, count):
    """Prepare the count of a right shift, which may be known earlier than the number.

    Returns the distance, in just enough bits to shift any number to nothing, and above it the bit "to the left".
    """
    source = operation.operands[0].fmt
    bits = (source.width + _grown(operation)).bit_length()
    left = negative(count)
    amount = count[: min(bits, len(count))]
    if bits < len(count):
        amount |= (~left & count[bits:].any()).replicate(bits)
    return Cat(amount[:bits], left)


def _grown(operation) -> int:
    """Return the fraction bits added to a number before its right shift."""
    return _rounding_bits(operation) + max(0, operation.fmt.frac_bits - operation.operands[0].fmt.frac_bits)


def _rounding_bits(operation) -> int:
    """Return the fraction bits that a shifted number has more than its result, to round with."""
    return int(operation.detail != "cut")


def _saturate(target: Q, rounded, floor):
    """Return (result, fault) as `golden.numbers.qarray.QArray.to` defines them.

    A number below the range saturates whether it is rounded up or not, and a number within can overflow upwards only.
    So only one comparison waits for the carry of the rounding.
    """
    above, below = _above(target, floor), _below(target, floor)
    over = Const(0)
    if rounded is not floor and not never(_above(target, rounded)):
        over = ~negative(floor) & rounded[target.width - target.signed]
    result = either(any_of(above, over), Const(target.raw_max, shape(target)), rounded)
    result = either(below, Const(target.raw_min, shape(target)), result)
    return result, any_of(above, _below(target, rounded))


def any_of(*bits: Value) -> Value:
    """Return the OR of these bits, without those that are the constant 0."""
    return functools.reduce(operator.or_, [bit for bit in bits if not never(bit)] or [Const(0)])


def _above(target: Q, value: Value) -> Value:
    """Return whether ``value`` is above the target's range: it is positive and has a bit beyond the target's."""
    magnitude = len(value) - value.shape().signed
    beyond = value[min(target.width - target.signed, magnitude) : magnitude]
    return ~negative(value) & beyond.any() if len(beyond) else Const(0)


def _below(target: Q, value: Value) -> Value:
    """Return whether ``value`` is below the target's range: it is negative and lacks a bit beyond the target's."""
    if not target.signed:
        return negative(value)
    beyond = value[min(target.width, len(value)) - 1 : -1]
    return negative(value) & ~beyond.all() if len(beyond) and value.shape().signed else Const(0)


STEPS = {
    "sum": total,
    "add": add,
    "sub": sub,
    "less": less,
    "select": select,
    "abs": absolute,
    "lead": lead,
    "shift_left": shift_left,
    "round": round_half_up,
    "shift_right": shift_right,
}


STEP_COUNTS = {"lead": 2, "shift_left": 2, "shift_right": 3}
"""How often these functions yield; a sum yields once for each addition of three terms, all others once."""


def step_count(operation) -> int:
    """Return the number of steps of an operation."""
    if operation.kind == "sum":
        return next(steps for steps in itertools.count(1) if 3**steps >= len(operation.operands))
    return STEP_COUNTS.get(operation.kind, 1)


def field(operation, x):
    """Return bits of the operand, or the operand itself in another format: wires only."""
    if operation.kind == "part":
        _, word = operation.operands[0].detail
        return word.field(operation.detail, x)
    if operation.kind == "field":
        x = x[operation.detail : operation.detail + operation.fmt.width]
    return x.as_signed() if operation.fmt.signed else x.as_unsigned()
