"""Blocks of ECP5 primitives: multipliers and block RAMs with the registers inside them, which no tool uses by itself.

``models.v``, beside this file, has behavioural models of the primitives.
"""

from amaranth.hdl import Cat, ClockSignal, Const, Instance, Module, Signal, Value

from hw.families.family import Blocks

WIDTH = 18
"""Operand bits of a multiplier."""

BLOCK_RAM_SHAPES = ((36, 512), (18, 1024), (9, 2048), (4, 4096), (2, 8192), (1, 16384))
"""(bits, words) that a block RAM can be, the widest first."""

ADDRESS_BITS = 14
"""Bits of a block RAM's address, which addresses a bit: a wider word leaves the lowest address bits unused."""

LOW, HIGH = Const(0, 1), Const(1, 1)

SELECT = 0xCACA
"""Contents of a lookup table: C ? B : A; D is not used."""

SELECT_OR_ZERO = 0x00CA
"""Contents of a lookup table: D ? 0 : C ? B : A."""


class Ecp5Blocks(Blocks):
    def get_multiplier(self, multiplier) -> Module | None:
        """A MULT18X18D with registers at its inputs and its output, and a third one between them or outside of it."""
        operands = multiplier.a, multiplier.b
        inside = multiplier.registers - multiplier.apart
        if inside > 3 or max(map(len, operands)) > WIDTH:
            return None
        m = Module()
        stages = ["INPUTA", "INPUTB", "OUTPUT"] + ["PIPELINE"] * (inside - 2)
        clocks = {f"p_REG_{stage}_CLK": "CLK0" for stage in stages}
        ports = {"i_CLK0": ClockSignal(), "i_CE0": HIGH, "i_RST0": LOW, **_inputs("C", [], WIDTH)}
        for name, operand in zip("AB", operands, strict=True):
            signed = operand.shape().signed
            ports |= {f"i_SIGNED{name}": HIGH if signed else LOW, f"i_SOURCE{name}": LOW}
            ports |= _inputs(name, operand, WIDTH, beyond=operand[-1] if signed else LOW)
        product = _word("product", len(multiplier.product))
        result = Cat(product)
        if multiplier.apart:
            result = Signal(len(product), name="apart", reset_less=True)
            m.d.sync += result.eq(Cat(product))
        m.d.comb += multiplier.product.eq(result)
        m.submodules.block = Instance("MULT18X18D", p_GSR="DISABLED", **clocks, **ports, **_outputs("P", product))
        return m

    def get_shift_stage(self, stage) -> Module | None:
        """Two lookup tables and the mux that joins them for each bit, which no tool finds; one lookup table where two
        of the four sources are zero."""
        if len(stage.times) == 1:
            return None
        m = Module()
        once, twice = stage.times
        out = _word("o", len(stage.o))
        m.d.comb += stage.o.eq(Cat(out))
        for n, bit in enumerate(out):
            sources = [stage.source(n, times) for times in range(4)]
            a, b, c, d = (LOW if source is None else source for source in sources)
            if all(source is None for source in sources[2:]):
                m.submodules[f"lut_{n}"] = _lookup(SELECT_OR_ZERO, bit, A=a, B=b, C=once, D=twice)
                continue
            halves = Signal(2, name=f"halves_{n}")
            for half, pair in enumerate(((a, b), (c, d))):
                table = _lookup(SELECT, halves[half], A=pair[0], B=pair[1], C=once, D=LOW)
                m.submodules[f"lut_{n}_{half}"] = table
            m.submodules[f"mux_{n}"] = Instance("PFUMX", i_BLUT=halves[0], i_ALUT=halves[1], i_C0=twice, o_Z=bit)
        return m

    def get_block_ram(self, ram) -> Module | None:
        """As few block RAMs side by side as hold the memory, with their output registers. Each holds some bits of every
        word, so that no mux follows."""
        fitting = [bits for bits, words in BLOCK_RAM_SHAPES if words >= ram.depth]
        if not fitting:
            return None
        m, bits = Module(), fitting[0]
        block = _wide if bits == 36 else _dual_port
        read = _word("data", len(ram.data))
        for low in range(0, len(read), bits):
            part = slice(low, low + bits)
            contents = [value >> low & (1 << bits) - 1 for value in ram.init]
            parameters = {"p_GSR": "DISABLED"} | _initial(contents, bits)
            m.submodules[f"block_{low}"] = block(ram, bits, ram.write_data[part], read[part], parameters)
        m.d.comb += ram.data.eq(Cat(read))
        return m


def _lookup(contents: int, output, **inputs) -> Instance:
    ports = {f"i_{name}": value for name, value in inputs.items()}
    return Instance("LUT4", p_INIT=Const(contents, 16), o_Z=output, **ports)


def _wide(ram, bits, data, read, parameters) -> Instance:
    """A write port and a read port of 36 bits. The primitive swaps the two halves of the word that is read."""
    return Instance(
        "PDPW16KD",
        p_DATA_WIDTH_W=bits, p_DATA_WIDTH_R=bits, p_REGMODE="OUTREG", **parameters,
        i_CLKW=ClockSignal(), i_CEW=ram.write, **_inputs("CSW", [], 3), **_inputs("BE", [HIGH] * 4, 4),
        **_inputs("ADW", ram.write_address, 9), **_inputs("DI", data, 36),
        i_CLKR=ClockSignal(), i_CER=HIGH, i_OCER=HIGH, i_RST=LOW, **_inputs("CSR", [], 3),
        **_inputs("ADR", _address(ram.address, bits), ADDRESS_BITS),
        **_outputs("DO", read[18:]), **_outputs("DO", read[:18], first=18),
    )  # fmt: skip


def _dual_port(ram, bits, data, read, parameters) -> Instance:
    """Two ports of at most 18 bits: port A writes, port B reads."""
    return Instance(
        "DP16KD",
        p_DATA_WIDTH_A=bits, p_DATA_WIDTH_B=bits, p_REGMODE_B="OUTREG", **parameters,
        i_CLKA=ClockSignal(), i_CEA=HIGH, i_OCEA=HIGH, i_WEA=ram.write, i_RSTA=LOW, **_inputs("CSA", [], 3),
        **_inputs("ADA", _address(ram.write_address, bits, enables=bits // 18 * 2), ADDRESS_BITS),
        **_inputs("DIA", data, 18),
        i_CLKB=ClockSignal(), i_CEB=HIGH, i_OCEB=HIGH, i_WEB=LOW, i_RSTB=LOW, **_inputs("CSB", [], 3),
        **_inputs("ADB", _address(ram.address, bits), ADDRESS_BITS), **_inputs("DIB", [], 18),
        **_outputs("DOB", read),
    )  # fmt: skip


def _address(address, bits: int, enables=0) -> list[Value]:
    """The address of a word's first bit, with eight bits counted for each byte of nine. A wide word doesn't need the
    lowest address bits; the primitive takes them for its byte ``enables``."""
    unused = (bits - bits // 9).bit_length() - 1
    return [HIGH] * enables + [LOW] * (unused - enables) + list(address)


def _inputs(name: str, bits, count: int, beyond=LOW) -> dict[str, Value]:
    """Connect ``bits`` to the pins ``name0``, ``name1`` ..., and ``beyond`` to those that are left."""
    return {f"i_{name}{n}": bits[n] if n < len(bits) else beyond for n in range(count)}


def _outputs(name: str, bits, first=0) -> dict[str, Value]:
    """Connect ``bits`` to the pins from ``name<first>`` on."""
    return {f"o_{name}{first + n}": bit for n, bit in enumerate(bits)}


def _word(name: str, count: int) -> list[Signal]:
    """Separate wires, one for each pin."""
    return [Signal(name=f"{name}_{n}") for n in range(count)]


def _initial(contents: list[int], bits: int) -> dict[str, str]:
    """Return a block RAM's initial contents as its parameters, none if all are 0.

    A block holds bytes of nine bits. Narrower words share the lower eight of a byte, a wider word takes several bytes.
    Each parameter has 16 pairs of bytes, with two unused bits after each pair.
    """
    in_a_byte, stride = max(1, 8 // bits), max(bits, 9)
    flat = 0
    for number, word in enumerate(contents):
        flat |= word << number // in_a_byte * stride + number % in_a_byte * bits
    pairs = [flat >> 18 * n & (1 << 18) - 1 for n in range(1024)] if flat else []
    rows = [pairs[low : low + 16] for low in range(0, len(pairs), 16)]
    values = [sum(pair << 20 * n for n, pair in enumerate(row)) for row in rows]
    return {f"p_INITVAL_{n:02X}": f"0x{value:080X}" for n, value in enumerate(values)}
