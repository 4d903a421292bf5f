"""What a run gives, kept in a folder, compared, measured and exported.

May import golden, hw, sim.encode and the registry of sim.backends; never sim.run or a command."""
