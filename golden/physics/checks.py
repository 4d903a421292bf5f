"""Checks of a user's numbers, for materials and dampers."""

from __future__ import annotations

import math

import numpy as np

from golden.support.errors import InputError


def check_number(name: str, value: float, positive: bool = True) -> None:
    """Raise `InputError` unless ``value`` is a finite number above 0, or of at least 0 if it needn't be positive."""
    real = isinstance(value, (int, float, np.integer, np.floating)) and not isinstance(value, bool)
    if not real or not math.isfinite(value) or value < 0 or (positive and value == 0):
        bound = "above" if positive else "of at least"
        raise InputError(f"{name} must be a finite number {bound} 0, not {value!r}")
