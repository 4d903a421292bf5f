"""The integer model of an edge (`golden.datapath.edge`), with the edges for which each rounding saturated."""

from collections import Counter

import numpy as np
from datapath_calls import call_edge

from golden.datapath.tables import Tables, inverse_table
from golden.numbers.graph import Graph, flatten
from golden.numbers.qarray import QArray
from golden.numbers.qformat import Q


class Watch:
    """A record of roundings and faults, in order.

    Attributes
    ----------
    rounded : list of (name, mask)
        Every rounding to a format with a name, and for which edges it was a fault (None: for none).
    flagged : list of (name, mask)
        Every other report of a fault.
    limits : Counter
        Roundings that gave the largest or smallest integer, (name, "on"), or one beyond, (name, "beyond");
        counted only if asked for.
    """

    def __init__(self, count_limits):
        self.rounded, self.flagged, self.limits = [], [], Counter()
        self.count_limits = count_limits


class Watched(QArray):
    """A `QArray` whose ``faults`` is a `Watch`."""

    __slots__ = ()

    def _new(self, raw, fmt):
        return Watched(raw, fmt, self.faults)

    def fault(self, name):
        self.faults.flagged.append((name, self.raw.astype(bool)))

    def to(self, fmt, **how):
        watch = self.faults
        before = len(watch.flagged)
        result = super().to(fmt, **how)
        if fmt.name:
            watch.rounded.append((fmt.name, watch.flagged.pop()[1] if len(watch.flagged) > before else None))
            if watch.count_limits:
                wide = super().to(Q(fmt.int_bits + 8, fmt.frac_bits), **how).raw
                for beyond, where in enumerate(("on", "beyond")):
                    hit = (wide == fmt.raw_max + beyond) | (wide == fmt.raw_min - beyond)
                    watch.limits[fmt.name, where] += np.count_nonzero(hit)
        return result


class EdgeModel:
    """One batch of edges through `golden.datapath.edge.edge`.

    Parameters
    ----------
    damper : dict
        `golden.datapath.records.damper_word` -> (tables, segments).
    inputs : dict of str to int64 arrays
        By the names of `golden.datapath.graphs.edge_graph`'s inputs.

    Attributes
    ----------
    values : dict of str to QArray
        Every quantity of the datapath, vectors by component.
    """

    def __init__(self, fmt, graph: Graph, damper, inputs, count_limits=False):
        self._graph, self._watch = graph, Watch(count_limits)
        numbers = {name: Watched(raw, graph.inputs[name].fmt, self._watch) for name, raw in inputs.items()}
        tables = Tables(fmt, inverse_table(fmt), damper)
        named = call_edge(fmt, tables, len(damper["rho_value"]), numbers)
        self.values = {label: x for name, value in named.items() for label, x in flatten(name, value)}

    def __getitem__(self, name):
        return self.values[name].raw

    @property
    def limits(self):
        return self._watch.limits

    def faults(self):
        """Return (the graph's operation, name of the fault, mask) for each operation that reported one."""
        rounding = [node for node in self._graph.operations if node.kind in ("round", "shift_right") and node.fmt.name]
        yield from self._matched([(node.fmt.name, node) for node in rounding], self._watch.rounded)
        yield from self._matched(self._graph.faults, self._watch.flagged)

    @staticmethod
    def _matched(operations, reports):
        assert [name for name, _ in operations] == [name for name, _ in reports]
        for (name, node), (_, mask) in zip(operations, reports, strict=True):
            if mask is not None and mask.any():
                yield node, name, mask
