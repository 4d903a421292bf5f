"""How fast: the circuit's step beside that of software on this machine."""
