"""The benchmark: the circuit's step beside that of software on this machine. Only the commands import it; it imports
golden and sim.support."""
