"""The operations of `golden.graph` as combinational steps; `hw.pipe` puts registers between them.

Each function takes ``wire``, a node of the graph and its operands' values, and yields one tuple of values after each
step, the result first. A register may follow any of them: the next step is given what the one before yielded,
registered or not. ``wire(value)`` gives a value that is used more than once a signal of its own, so that the Verilog
says it once.
"""

from amaranth.hdl import Cat, Const, Mux, Shape, Value

from golden.qformat import Q


def shape(q: Q) -> Shape:
    return Shape(q.width, q.signed)


def aligned(*operands):
    """Values whose lowest bits mean the same, from (value, format) pairs."""
    frac = max(q.frac_bits for _, q in operands)
    return [value << frac - q.frac_bits for value, q in operands]


def _pair(node, a, b):
    first, second = node.operands[-2:]
    return aligned((a, first.fmt), (b, second.fmt))


def add(wire, node, a, b):
    x, y = _pair(node, a, b)
    yield (x + y,)


def sub(wire, node, a, b):
    x, y = _pair(node, a, b)
    yield (x - y,)


def less(wire, node, a, b):
    x, y = _pair(node, a, b)
    yield (x < y,)


def select(wire, node, bit, yes, no):
    x, y = _pair(node, yes, no)
    yield (Mux(bit, x, y),)


def absolute(wire, node, a):
    yield (Mux(a < 0, -a, a),)


def lead(wire, node, *vector):
    """Leading zeros of the OR of all magnitudes."""
    magnitude = Const(0)
    for x in vector:
        magnitude |= (x[:-1] ^ x[-1].replicate(len(x) - 1)) if x.shape().signed else x
    (magnitude,) = yield (wire(magnitude)[-node.detail :],)
    yield (_leading_zeros(wire(magnitude)),)


def _leading_zeros(bits: Value) -> Value:
    """As a tree: the count of the upper half, or half the width and the count of the lower."""
    width = len(bits)
    if width == 1:
        return ~bits
    half = 1 << (width - 1).bit_length() - 1
    upper, lower = bits[width - half :], bits[: width - half]
    return Mux(upper == 0, half + _leading_zeros(lower), _leading_zeros(upper))


def shift_left(wire, node, x, count):
    """Bits that leave at the top are redundant (`lead`)."""
    for bit in reversed(range(len(count))):
        x = wire(Mux(count[bit], Cat(Const(0, 1 << bit), x)[: len(x)], x))
    yield (x.as_signed() if node.fmt.signed else x,)


def round_half_up(wire, node, x):
    """Operand's fraction bits beyond the format's are dropped, then the result saturates; second value: the fault."""
    source, target = node.operands[0].fmt, node.fmt
    drop = source.frac_bits - target.frac_bits
    if drop <= 0:
        value = x << -drop
        yield _saturate(target, value, value)
    else:
        yield _saturate(target, wire((x + (1 << drop - 1)) >> drop), x >> drop)


def shift_right(wire, node, x, count):
    """Rounds and saturates ``x * 2**-count``; second value: the fault."""
    source, target = node.operands[0].fmt, node.fmt
    x = x << 1 + max(0, target.frac_bits - source.frac_bits)  # one bit more than the result, to round with
    drop = max(0, source.frac_bits - target.frac_bits)
    bits = (len(x) - 1).bit_length()  # a longer shift leaves nothing
    amount = count[: min(bits, len(count))]
    far = (count >> bits) != 0
    negative = count < 0
    for bit in reversed(range(3, len(amount))):
        x = wire(Mux(amount[bit], x >> (1 << bit), x))
    x, amount, far, beyond = yield x, amount[:3], far & ~negative, negative & (x != 0)
    for bit in reversed(range(len(amount))):
        x = wire(Mux(amount[bit], x >> (1 << bit), x))
    x = Mux(far, 0, x) >> drop
    x, beyond, below = yield x, beyond, x < 0
    result, fault = _saturate(target, wire((x + 1) >> 1), x >> 1)
    extreme = Mux(below, Const(target.raw_min, shape(target)), Const(target.raw_max, shape(target)))
    yield Mux(beyond, extreme, result), fault | beyond


def _saturate(target: Q, rounded, floor):
    """(result, fault): see `golden.qarray.QArray.to`."""
    low, high = Const(target.raw_min, shape(target)), Const(target.raw_max, shape(target))
    under = rounded < low
    return Mux(under, low, Mux(rounded > high, high, rounded)), under | (floor > high)


STEPS = {
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

STEP_COUNT = {"lead": 2, "shift_right": 3}
"""Steps of the operations that have more than one."""


def field(node, x):
    """Wires only: bits of the operand, or the operand as it is in another format."""
    if node.kind == "field":
        x = x[node.detail : node.detail + node.fmt.width]
    elif node.kind == "part":
        low = 0
        _, word = node.operands[0].detail
        for name, q in word.items():
            if name == node.detail:
                break
            low += q.width
        x = x[low : low + node.fmt.width]
    return x.as_signed() if node.fmt.signed else x.as_unsigned()

