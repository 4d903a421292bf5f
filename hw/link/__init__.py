"""The link: how a host talks to the circuit over two wires."""
