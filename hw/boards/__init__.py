"""Boards: their files and tops, the timing and bitstream of a circuit on one, and the programs that this needs.

May import all of hw; it is imported by the commands, and by sim for the published timing."""
