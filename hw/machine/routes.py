"""Registers on long routes. Each constant is the length of a delay line: with another value the circuit computes the
same integers in more or fewer cycles, or is refused."""

from hw.blocks.memory import READ_LATENCY

HANDOVER = 3
"""Registers from the host port to a memory's ports, those at the ports included. A run starts that much later."""

CHOICE = 2
"""Cycles of each of three muxes in a row: of a memory's words, of the lanes, of the regions."""

COPIED = 1
"""Registers from a node's new state to its copies in the lanes."""

STAGED = 1
"""Registers from the issue of a row to the stage bits on the lanes' ports."""

PORT = 1
"""Registers at a memory's ports (`hw.machine.memory_ports`): the last of the route to it."""

FOUND = HANDOVER + READ_LATENCY
"""Cycles from the host's index at a lane or an updater to the word that its memories hold there."""

MEMORY = 1 + FOUND
"""Cycles from an access of the host port to its word; the 1 is the register of `hw.machine.access`."""
