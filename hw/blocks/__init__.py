"""Small blocks of an FPGA in plain Amaranth, one module each; a family's own twins of them are in `hw.families`. They
import nothing of hw."""
