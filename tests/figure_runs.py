"""The runs that the figures are drawn from, each computed once for all tests of a process."""

from functools import cache

from sim.figures import runs


@cache
def pair(name):
    """Circuit (integer model) and float64 of a scene, by its name in the figures."""
    return runs.pair(runs.load(name), backend="fixed")
