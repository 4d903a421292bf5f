"""The backend that simulates the circuit's emitted Verilog with Verilator."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from golden.support import paths
from golden.support.errors import InputError
from hw.parameters import Parameters
from hw.sizes import SIZES, Size
from sim.backends import waves
from sim.backends.backend import IntegerBackend, Option
from sim.backends.machine import ClockedMachine
from sim.encode import limits
from sim.encode.encode import EncodedScene
from sim.support.arguments import whole

BUILD = paths.BUILD / "rtl"
"""Folder of the compiled circuits."""
LANES, UPDATES = 2, 1


def _size_option(size: Size, default: int) -> Option:
    keywords = {"type": whole, "metavar": size.letter}
    return Option(size.name, f"{size.meaning}, {size.choice} ({default})", keywords)


SIZE_OPTIONS = _size_option(SIZES["lanes"], LANES), _size_option(SIZES["updates"], UPDATES)
WAVES = Option(
    "waves",
    "write the waveforms of the circuit's first 5000 busy cycles as well (vcd, which is larger but needs no library)",
    {"nargs": "?", "const": "vcd", "choices": waves.FORMATS, "metavar": "vcd|fst"},
)


@dataclass(frozen=True)
class RtlBackend(IntegerBackend):
    """The circuit's Verilog under Verilator, with ``lanes`` edge processors and ``updates`` node updaters.

    ``waves`` is the file to which its waveforms are written, .vcd or .fst.
    """

    lanes: int = LANES
    updates: int = UPDATES
    waves: Path | None = None

    name = "rtl"
    words = "Verilog in simulation"
    summary = "the circuit's Verilog under Verilator"
    compared = True
    options = *SIZE_OPTIONS, WAVES

    @classmethod
    def from_options(cls, args: Namespace, out: Path) -> RtlBackend:
        """Return the backend that the command line asks for."""
        return cls(args.lanes or LANES, args.updates or UPDATES, args.waves and out / f"waves.{args.waves}")

    @property
    def parameters(self) -> Parameters:
        """The circuit that is simulated. Raises `InputError` for sizes that it can't have."""
        try:
            return Parameters(lanes=self.lanes, updates=self.updates)
        except ValueError as error:
            raise InputError(str(error)) from None

    def check(self) -> None:
        """Raise `InputError` for sizes that the circuit can't have, or waveforms that can't be recorded here."""
        if self.waves is not None:
            waves.check(self.waves)
        _ = self.parameters

    def check_room(self, encoded: EncodedScene) -> None:
        """Raise `InputError` for an object that is larger than the circuit, with the materials of any phase."""
        check_room(encoded, self.parameters)

    @contextmanager
    def open(self, encoded: EncodedScene) -> Iterator[ClockedMachine]:
        """Give the simulated circuit, loaded; it is compiled unless it has been before."""
        from sim.backends.circuit import CircuitMachine
        from sim.backends.simulated_circuit import SimulatedCircuit  # Amaranth and Verilator are slow to load

        self.check_room(encoded)
        circuit = SimulatedCircuit(self.parameters, BUILD, self.waves)
        try:
            yield CircuitMachine(encoded.image, circuit)
        finally:
            circuit.close()


def check_room(encoded: EncodedScene, parameters: Parameters) -> None:
    """Raise `InputError` for an object that is larger than a circuit, with the materials of any phase."""
    from sim.encode.program import Program  # the memory map is slow to load

    for phase in (encoded, *limits.later_materials(encoded)):
        Program(phase.image, parameters)
