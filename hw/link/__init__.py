"""The link: how a host talks to the circuit over two wires. It imports machine, map and parameters; emit, boards and
the host's side in `sim.backends.link` import it."""
