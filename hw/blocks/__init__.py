"""Hard blocks of an FPGA, one small module each, in plain Amaranth; `hw.families` has the same from primitives."""
