"""What Yosys' cells take of a device, family by family."""

from msgspec import Struct


class Sizes(Struct, forbid_unknown_fields=True):
    """What the circuit takes of a device. ``lut`` counts all lookup tables, those of adders and memories included."""

    lut: int
    ff: int
    multipliers: int
    block_rams: int
    lut_ram: int

    def __sub__(self, other: "Sizes") -> "Sizes":
        return Sizes(*(getattr(self, name) - getattr(other, name) for name in self.__struct_fields__))


LOOKUP_TABLES = {
    # An adder of two bits has two lookup tables, a memory of 16x4 four
    "ecp5": {"LUT4": 1, "CCU2C": 2, "TRELLIS_DPR16X4": 4},
    # A bit of an adder stands where a lookup table would; a memory of 16x4 takes half of a tile of eight
    "gowin": {"LUT1": 1, "LUT2": 1, "LUT3": 1, "LUT4": 1, "ALU": 1, "RAM16SDP4": 4},
    # The lookup tables of adders are cells of their own
    "xilinx": {**{f"LUT{inputs}": 1 for inputs in range(1, 7)}, "RAM32M": 4, "RAM64M": 4, "SRL16E": 1, "SRLC32E": 1},
}
LUT_RAM = {"ecp5": ("TRELLIS_DPR16X4",), "gowin": ("RAM16SDP4",), "xilinx": ("RAM32M", "RAM64M")}
FLIP_FLOPS = {
    "ecp5": ("TRELLIS_FF",),
    "gowin": ("DFF", "DFFE", "DFFS", "DFFSE", "DFFR", "DFFRE", "DFFP", "DFFPE", "DFFC", "DFFCE"),
    "xilinx": ("FDRE", "FDSE", "FDCE", "FDPE"),
}
MULTIPLIERS = {"ecp5": "MULT18X18D", "gowin": "MULT27X36", "xilinx": "DSP48E1"}
BLOCK_RAMS = {  # of about 18 kbit
    "ecp5": {"DP16KD": 1, "PDPW16KD": 1},
    "gowin": {name: 1 for name in ("SP", "SPX9", "SDPB", "SDPX9B", "DPB", "DPX9B", "pROM", "pROMX9")},
    "xilinx": {"RAMB18E1": 1, "RAMB36E1": 2},
}


def sizes(cells: dict[str, int], family: str) -> Sizes:
    """Of a number of cells of each kind."""
    tables = {name: count * cells.get(name, 0) for name, count in LOOKUP_TABLES[family].items()}
    return Sizes(
        lut=sum(tables.values()),
        ff=sum(cells.get(name, 0) for name in FLIP_FLOPS[family]),
        multipliers=cells.get(MULTIPLIERS[family], 0),
        block_rams=sum(count * cells.get(name, 0) for name, count in BLOCK_RAMS[family].items()),
        lut_ram=sum(tables[name] for name in LUT_RAM[family]),
    )
