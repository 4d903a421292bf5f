"""The runs that the figures are drawn from, each computed once per test process."""

from functools import cache

from sim.figures import runs


@cache
def pair(name):
    """Return the runs of a scene on the integer model and on float64, by its name in the figures."""
    return runs.pair(runs.load(name), backend="fixed")
