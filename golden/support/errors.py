"""Two exceptions: one for the user's mistakes, one for this project's."""

from __future__ import annotations


class InputError(ValueError):
    """A mistake in what the user gave: ``str(error)`` is the one line to print, without a traceback.

    A message starts with the name of what is wrong, ``k must be a positive number, not -1``, so that a caller
    who knows where the name stands in the user's file can prefix the path with `InputError.under`.
    """

    def under(self, path: str) -> InputError:
        """Return the same error after a path: under ``materials.gel`` it is ``materials.gel.k must be ...``."""
        return InputError(f"{path}.{self}")


class InternalError(RuntimeError):
    """Two models that must agree do not: a bug of this project."""
