"""The contents of the circuit's memories, as integers in the formats of `golden.datapath.formats`."""

from dataclasses import dataclass, field

import numpy as np

from golden.datapath.formats import Formats
from golden.datapath.tables import inverse_table


@dataclass(eq=False)
class MemoryImage:
    """An object of N nodes, E edges, M materials and T damper tables; vectors always have three components.

    The circuit works in the order of nodes and edges here. The order changes the speed, never the result.
    """

    formats: Formats
    velocity_shift: int  # the velocity full scale is 2^-velocity_shift sizes per step
    x: np.ndarray  # (N, 3) position
    v: np.ndarray  # (N, 3) velocity
    load: np.ndarray  # (N, 3) accumulator
    inverse_mass: dict[str, np.ndarray]  # records.inverse_mass -> (N,)
    edges: np.ndarray  # (E, 2) node numbers
    edge_material: np.ndarray  # (E,)
    length: np.ndarray  # (E,) length
    ratio: np.ndarray  # (E,) ratio
    materials: list[dict[str, int]]  # records.material
    damper: dict[str, np.ndarray]  # records.damper_word -> (T, segments)
    inverse: dict[str, np.ndarray] = field(init=False)  # records.inverse_word -> (entries,)

    def __post_init__(self):
        self.inverse = inverse_table(self.formats)

    @property
    def nodes(self) -> int:
        return len(self.x)
