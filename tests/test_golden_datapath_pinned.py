"""Integers that must not change unnoticed: inputs and outputs of some edges and nodes, checked in.

After a change that is meant, ``RHEOGATE_PIN=1 pytest tests/test_golden_datapath_pinned.py`` writes the outputs anew.
"""

import json
import os
import zlib
from collections import Counter
from pathlib import Path

import numpy as np
import pytest
from datapath_calls import call_edge, call_node

from golden.datapath import records
from golden.datapath.formats import Formats
from golden.datapath.graphs import edge_graph, node_graph
from golden.datapath.tables import Tables, inverse_table
from golden.numbers.graph import flatten
from golden.numbers.qarray import QArray

FILE = Path(__file__).with_name("pinned.json")
FMT = Formats()


def damper():
    """Return a table whose contents come from integers only."""
    segment = np.arange(1 << FMT.damper_index.width)
    factors = 7919, 104729, 15485863, 49979687, 86028121, 122949823
    fields = zip(records.damper_word(FMT).items(), factors, strict=True)
    return {name: (segment * factor % (q.raw_max + 1))[None] for (name, q), factor in fields}


def numbers(graph, raw, faults):
    return {name: QArray(np.array(raw[name], np.int64), q.fmt, faults) for name, q in graph.inputs.items()}


def outputs(graph, values, faults):
    labels = dict(pair for name, value in values.items() for pair in flatten(name, value))
    return {label: labels[label].raw.tolist() for label in graph.outputs} | {"faults": dict(sorted(faults.items()))}


def edges(raw):
    graph, faults = edge_graph(FMT, tables=1), Counter()
    tables = Tables(FMT, inverse_table(FMT), damper())
    return outputs(graph, call_edge(FMT, tables, 1, numbers(graph, raw, faults)), faults)


def nodes(raw):
    graph, faults = node_graph(FMT, banks=1), Counter()
    return outputs(graph, call_node(FMT, 1, numbers(graph, raw, faults)), faults)


def tables(raw):
    """Checksums, the same on every computer."""
    return {name: zlib.crc32(np.asarray(values, "<i8").tobytes()) for name, values in inverse_table(FMT).items()}


@pytest.mark.parametrize("compute", [edges, nodes, tables], ids=lambda compute: compute.__name__)
def test_integers_are_the_ones_that_were_checked_in(compute):
    pinned = json.loads(FILE.read_text())
    case = pinned[compute.__name__]
    got = compute(case["inputs"])
    if os.environ.get("RHEOGATE_PIN"):
        case["outputs"] = got
        FILE.write_text(text(pinned))
    assert got == case["outputs"]


def text(pinned):
    """Return JSON with a line for each name."""
    blocks = []
    for name, case in pinned.items():
        parts = []
        for part, values in case.items():
            lines = ",\n".join(f"   {json.dumps(key)}: {json.dumps(value)}" for key, value in values.items())
            parts.append(f"  {json.dumps(part)}: {{\n{lines}\n  }}")
        blocks.append(f" {json.dumps(name)}: {{\n" + ",\n".join(parts) + "\n }")
    return "{\n" + ",\n".join(blocks) + "\n}\n"
