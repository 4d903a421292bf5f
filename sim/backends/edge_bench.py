"""A test bench of the edge processor alone: its Verilog under Verilator, batches of edges, one a cycle."""

import ctypes
from pathlib import Path

import numpy as np

from golden.datapath import records
from hw.emit.verilog import convert
from hw.machine.edge import EdgeDatapath, EdgeProcessor
from hw.pipeline.pipe import FAULT_LATENCY
from sim.backends.verilated import library, opened

TOP = "rheogate_edge"
SHIM = Path(__file__).with_name("edge_bench.cpp")


class EdgeBench:
    """A simulated `hw.machine.edge.EdgeProcessor`.

    Each input has its value in the cycle in which the schedule samples it and noise in all others; each output is
    sampled in its cycle.

    Parameters
    ----------
    datapath : EdgeDatapath
    folder : Path
        Folder of the compiled circuits.

    Attributes
    ----------
    inputs, outputs : list of str
        Names of the columns of vectors and of results.
    """

    def __init__(self, datapath: EdgeDatapath, folder: Path):
        self.datapath = datapath
        arrival, graph = datapath.schedule.arrival, datapath.graph
        inputs = {name: (node.fmt.width, arrival.get(name, 0)) for name, node in graph.inputs.items()}
        del inputs["velocity_shift"]  # constant during a batch
        outputs = {name: (node.fmt.width, datapath.ready(name)) for name, node in graph.outputs.items()}
        self.inputs, self.outputs = list(inputs), list(outputs)
        self._drain = max(datapath.schedule.latency + FAULT_LATENCY, *map(datapath.ready, graph.outputs)) + 1

        text = convert(EdgeProcessor(datapath), TOP)
        folder.mkdir(parents=True, exist_ok=True)
        shim = folder / f"{TOP}_bench.cpp"
        shim.write_text(_ports("INPUT", "inputs", inputs) + _ports("OUTPUT", "outputs", outputs) + SHIM.read_text())
        shared = opened(library(TOP, text, shim, folder=folder))
        self._shared = shared
        shared.bench_new.restype = ctypes.c_void_p
        shared.bench_delete.argtypes = [ctypes.c_void_p]
        shared.bench_table.argtypes = [ctypes.c_void_p, ctypes.c_int, ctypes.c_long, ctypes.c_void_p]
        shared.bench_run.argtypes = [ctypes.c_void_p, ctypes.c_int, ctypes.c_long, *[ctypes.c_void_p] * 4]
        self._handle = shared.bench_new()

    def close(self):
        """Free the simulated edge processor."""
        if self._handle:
            self._shared.bench_delete(self._handle)
            self._handle = None

    def load(self, damper: dict[str, np.ndarray]):
        """Load the damper tables: `golden.datapath.records.damper_word` -> (tables, segments)."""
        word, flat = records.damper_word(self.datapath.formats), {name: x.ravel() for name, x in damper.items()}
        for half, quantity in enumerate(("rho", "sigma")):
            packed = word.starting_with(quantity).pack(flat)
            self._shared.bench_table(self._handle, half, len(packed), packed.ctypes.data)

    def run(self, vectors: np.ndarray, velocity_shift: int, entry: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Send edges through the pipeline.

        Parameters
        ----------
        vectors : (n, inputs) int64
            Raw integers.
        entry : (cycles,) int64
            The row of ``vectors`` that enters in each cycle, or -1; each row once.

        Returns
        -------
        results : (n, outputs) int64
        faults : (cycles + drain,) uint32
            The fault port in each cycle, until the pipeline is empty.
        """
        vectors = np.ascontiguousarray(vectors, np.int64)
        assert vectors.shape[1] == len(self.inputs)
        assert np.array_equal(np.sort(entry[entry >= 0]), np.arange(len(vectors)))
        entry = np.concatenate([entry, np.full(self._drain, -1)]).astype(np.int64)
        results = np.zeros((len(vectors), len(self.outputs)), np.int64)
        faults = np.zeros(len(entry), np.uint32)
        pointers = [a.ctypes.data for a in (entry, vectors, results, faults)]
        self._shared.bench_run(self._handle, velocity_shift, len(entry), *pointers)
        return results, faults


def _ports(kind: str, interface: str, ports: dict[str, tuple[int, int]]) -> str:
    """Return the list that the shim wants; Verilator writes ``___05F`` for the ``__`` after an interface's name."""
    listed = " ".join(f"X({interface}___05F{name}, {bits}, {cycle})" for name, (bits, cycle) in ports.items())
    return f"#define {kind}S(X) {listed}\nenum {{ {kind}_COUNT = {len(ports)} }};\n"
