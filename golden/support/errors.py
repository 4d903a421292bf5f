"""The one exception a user's mistake ends in, and the one for a mistake of ours."""

from __future__ import annotations


class InputError(ValueError):
    """A mistake in what the user gave: ``str(error)`` is the one line to print, without a traceback.

    A message starts with the name of what is wrong, ``k must be a positive number, not -1``, so that whoever
    knows where that name stands in the user's file can put the path before it with `under`.
    """

    def under(self, path: str) -> InputError:
        """The same error, `path` before it: under ``materials.gel`` it is ``materials.gel.k must be ...``."""
        return InputError(f"{path}.{self}")


class InternalError(RuntimeError):
    """Two models that must agree do not: a bug of this project."""
