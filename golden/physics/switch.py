"""Another material for a deformed object, without a jump in force."""

from __future__ import annotations

import numpy as np

from golden.physics.materials import Material


def switch_material(old: Material, new: Material, length, rate, ratio, natural) -> tuple[np.ndarray, np.ndarray]:
    """Return ratios and natural lengths with which edges of the new material carry the force that they carry now.

    The force of equations (1) to (3) is -rho g with g = k (a l - L) + c1 dl/dt. A ratio strictly within the new
    material's limits is kept, any other becomes the new a0; then L follows from the force. Without a spring (k = 0)
    no force can be kept at rest: L is a l, and the force is what the new dampers give.

    Parameters
    ----------
    length, rate, ratio, natural : (E,)
        l (m), dl/dt (m/s), a and L (m) of the edges.

    Returns
    -------
    ratio, natural : (E,)
    """
    length, rate, ratio, natural = np.broadcast_arrays(length, rate, ratio, natural)
    g = old.k * (ratio * length - natural) + old.c1 * rate
    rho, _ = old.rho_sigma(g)
    pull = rho * g
    inside = (new.a_min < ratio) & (ratio < new.a_max)
    ratio = np.where(inside, ratio, new.a0)
    if not new.k:
        return ratio, ratio * length
    return ratio, ratio * length - (new.trial_force(pull) - new.c1 * rate) / new.k
