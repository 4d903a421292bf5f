"""The ways to compute a scene, each one `sim.backends.backend.Backend`, and the machines that they open.

May import golden, hw, sim.encode and sim.support; never sim.results, sim.run or a command."""
