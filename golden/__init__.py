"""The specification one can run: what the object does, in float64 and in the circuit's integers.

It imports neither hw nor sim."""
