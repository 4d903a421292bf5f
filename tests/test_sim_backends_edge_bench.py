"""The emitted Verilog of the edge processor against the integer model: every output bit and fault, by the million.

Every batch has its own tables and velocity shift, and gaps between its edges: none at all, or at random.
"""

from collections import Counter

import numpy as np
import pytest
from edge_model import EdgeModel
from edge_vectors import batch, damper_tables

from golden.datapath.formats import Formats
from hw.machine.edge import EdgeDatapath
from hw.pipeline.cost import Cost
from hw.pipeline.pipe import FAULT_LATENCY
from sim.backends.edge_bench import EdgeBench
from sim.backends.rtl import BUILD

FORMATS = Formats()
TABLES, BATCH, BATCHES = 4, 50_000, 41
VECTORS = BATCH * BATCHES
# A sixth of 1 / l is less than 1, |u| is at most 1 with the table of 1 / sqrt(q) that the circuit has, and so is sigma
# times the mantissa of |g|: nothing can saturate these
NEVER = {"inverse length", "direction", "length rate", "mantissa"}


@pytest.fixture(scope="module")
def bench():
    bench = EdgeBench(EdgeDatapath(FORMATS, TABLES, Cost()), BUILD)
    yield bench
    bench.close()


class Run:
    """A batch of edges through model and circuit, with ``results`` and ``faults`` of each."""

    def __init__(self, bench, rng, n, gaps, count_limits=False):
        self.bench, graph = bench, bench.datapath.graph
        damper = damper_tables(rng, FORMATS, TABLES)
        self.shift = shift = int(rng.choice([rng.integers(0, 25), 127], p=[0.95, 0.05]))
        self.inputs = batch(rng, graph, FORMATS, damper, shift, n)
        self.model = EdgeModel(FORMATS, graph, damper, self.inputs | {"velocity_shift": np.int64(shift)}, count_limits)
        self.vectors = np.stack([self.inputs[name] for name in bench.inputs], axis=1)
        self.cycle = np.arange(n) + np.cumsum(rng.random(n) < gaps)
        entry = np.full(self.cycle[-1] + 1, -1)
        entry[self.cycle] = np.arange(n)
        bench.load(damper)
        self.results, self.faults = bench.run(self.vectors, shift, entry)
        self.expected = np.stack([np.broadcast_to(self.model[name], n) for name in bench.outputs], axis=1)
        self.fault_counts = Counter()
        self.expected_faults = self._expected_faults()

    def _expected_faults(self):
        """Return the fault port's bits in each cycle, of several edges: their operations lie at different depths."""
        word, datapath = np.zeros_like(self.faults), self.bench.datapath
        for node, name, mask in self.model.faults():
            when = self.cycle[mask] + datapath.schedule.cycle[node] + FAULT_LATENCY
            word[when] |= np.uint32(1 << datapath.faults.index(name))
            self.fault_counts[name] += np.count_nonzero(mask)
        return word

    def differences(self) -> list[str]:
        """Return a line for each quantity in which the circuit differs from the model."""
        wrong = [
            f"{name} of edge {row} is {self.results[row, column]}, not {self.expected[row, column]}"
            for row, column in np.argwhere(self.results != self.expected)[:5]
            for name in [self.bench.outputs[column]]
        ]
        for c in np.flatnonzero(self.faults != self.expected_faults)[:5]:
            wrong.append(f"faults of cycle {c} are {self.faults[c]:#x}, not {self.expected_faults[c]:#x}")
        return wrong

    def corners(self) -> Counter:
        """Return the number of edges that lie exactly on each of the datapath's decisions."""
        m, inputs = self.model, self.inputs
        end = 1 << FORMATS.damper_index.width + FORMATS.damper_fraction.width
        table = ~m["below"].astype(bool) & m["between"].astype(bool)
        at_g1, at_g2 = m["size"] == inputs["material_g1"], m["size"] == inputs["material_g2"]
        return Counter(
            {
                name: int(np.count_nonzero(mask))
                for name, mask in {
                    "|g| = g1": at_g1,
                    "|g| = g2 > g1": at_g2 & ~at_g1,
                    "|g| = g1 - 1": m["size"] == inputs["material_g1"] - 1,
                    "|g| = g2 - 1": m["size"] == inputs["material_g2"] - 1,
                    "|g| below g1": m["below"] == 1,
                    "|g| in the table": table,
                    "|g| above": ~table & (m["below"] == 0),
                    "g = 0": m["size"] == 0,
                    "g < 0": m["negative"] == 1,
                    "q < 1": m["short"] == 1,
                    "q >= 1": m["short"] == 0,
                    "too short": m["degenerate"] == 1,
                    "a segment's edge": table & (m["table_position"] % (1 << FORMATS.damper_fraction.width) == 0),
                    "before the table": table & (m["table_position"] < 0),
                    "after the table": table & (m["table_position"] >= end),
                    "first segment": table & (m["table_position"] == m["table_position"] % end) & (m["segment"] == 0),
                    "last segment": table & (m["table_position"] == m["table_position"] % end) & (m["segment"] == 511),
                    "shift of 0 for f": m["f_shift"] == 0,
                    "shift of -1 for f": m["f_shift"] == -1,
                    "shift of 0 for s": m["s_shift"] == 0,
                    "shift of -1 for s": m["s_shift"] == -1,
                }.items()
            }
        )


def hashes(rows):
    """Return (n,) a hash of each row of integers: rows with different hashes differ."""
    factors = np.random.default_rng(1).integers(1, 1 << 63, rows.shape[1], dtype=np.uint64) | np.uint64(1)
    mixed = (rows.astype(np.uint64) * factors).sum(axis=1, dtype=np.uint64)
    return (mixed ^ mixed >> np.uint64(29)) * np.uint64(0xBF58476D1CE4E5B9)


@pytest.mark.campaign
def test_two_million_edges_are_the_same_bits_with_the_same_faults(bench, seed):
    print(f"seed {seed}")
    stimuli, answers, faults, corners, limits = [], [], Counter(), Counter(), Counter()
    for number in range(BATCHES):
        rng = np.random.default_rng([seed, number])
        run = Run(bench, rng, BATCH, gaps=0 if number % 4 == 0 else rng.uniform(0, 0.5), count_limits=number % 4 == 0)
        assert run.differences() == [], f"batch {number}"
        stimuli.append(hashes(run.vectors))
        answers.append(hashes(run.results))
        faults += run.fault_counts
        corners += run.corners()
        limits += run.model.limits

    distinct, different = (len(np.unique(np.concatenate(one))) for one in (stimuli, answers))
    print(f"{VECTORS} edges, {distinct} distinct, {different} distinct results", faults, corners, limits, sep="\n")
    assert VECTORS >= 2_000_000 and distinct >= 0.999 * VECTORS
    assert different >= 0.9 * VECTORS
    assert set(faults) == set(bench.datapath.faults) - NEVER
    assert min(faults.values()) >= 1000
    few = {name: count for name, count in corners.items() if count < 1000}
    assert len(corners) == 21 and not few
    for name in ("trial force", "creep rate", "ratio", "share"):
        assert limits[name, "on"] >= 10 and limits[name, "beyond"] >= 10, name
    assert limits["mantissa", "on"] >= 10


def test_one_wrong_bit_is_reported(bench, rng):
    run = Run(bench, rng, 2000, gaps=0.3)
    assert run.differences() == []
    for column, name in enumerate(bench.outputs):
        row, bit = int(rng.integers(2000)), int(rng.integers(FORMATS.force.width))
        right = run.expected[row, column]
        run.expected[row, column] ^= 1 << bit
        assert run.differences() == [f"{name} of edge {row} is {right}, not {run.expected[row, column]}"]
        run.expected[row, column] = right
    run.expected_faults[700] ^= 4
    assert len(run.differences()) == 1 and run.differences()[0].startswith("faults of cycle 700 are ")


def test_one_wrong_bit_of_an_operand_is_noticed(bench, rng):
    """The circuit gets one edge with another integer than the model's: only that edge's results differ."""
    run = Run(bench, rng, 2000, gaps=0)
    row = int(np.flatnonzero((run.expected[:, :3] != 0).all(axis=1))[0])
    run.vectors[row, bench.inputs.index("j_x_x")] ^= 1 << FORMATS.position.width - 2
    run.results, _ = bench.run(run.vectors, run.shift, np.arange(2000))
    assert set(np.argwhere(run.results != run.expected)[:, 0]) == {row}


def test_an_edge_after_a_gap_is_not_disturbed_by_values_in_the_gap(bench, seed):
    """The same edges give the same results close together and far apart."""
    close, apart = (Run(bench, np.random.default_rng(seed), 500, gaps) for gaps in (0, 0.9))
    assert close.differences() == [] and apart.differences() == []
    assert np.array_equal(close.results, apart.results)
    assert len(apart.faults) > 1.5 * len(close.faults)
