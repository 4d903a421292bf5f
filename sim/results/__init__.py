"""The results of runs: kept in folders, compared, measured and exported.

May import golden, hw, sim.encode and the registry of sim.backends; never sim.run or a command."""
