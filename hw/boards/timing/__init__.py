"""How fast the circuit is on a board, and how large: synthesis, place and route, static timing."""
