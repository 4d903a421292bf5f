"""Records: fixed-point fields packed side by side in one word."""

from collections.abc import Mapping

import numpy as np

from golden.numbers.qformat import Q

INTEGERS = (int, np.integer, np.ndarray)


class Record(Mapping):
    """Named fields of a word, the first one lowest: a mapping from name to format, in that order.

    Attributes
    ----------
    width : int
        Bits of the whole word.
    offsets : dict of str to int
        The lowest bit of each field.
    """

    def __init__(self, fields: Mapping[str, Q]):
        self._fields = dict(fields)
        self.offsets, self.width = {}, 0
        for name, fmt in self._fields.items():
            self.offsets[name] = self.width
            self.width += fmt.width

    def __getitem__(self, name: str) -> Q:
        return self._fields[name]

    def __iter__(self):
        return iter(self._fields)

    def __len__(self):
        return len(self._fields)

    def __repr__(self):
        return f"Record({', '.join(f'{name}: {fmt}' for name, fmt in self.items())})"

    def starting_with(self, prefix: str) -> "Record":
        """The record of the fields whose names begin with ``prefix``, packed anew."""
        return Record({name: fmt for name, fmt in self.items() if name.startswith(prefix)})

    def pack(self, values: Mapping):
        """Return the word that holds ``values``: an int, or an int64 array if they are arrays.

        Raises
        ------
        ValueError
            If a value does not fit its format, or a word of arrays does not fit an int64.
        """
        word = 0
        for name, fmt in self.items():
            raw = _checked(name, fmt, values[name])
            if isinstance(raw, np.ndarray) and self.width > 63:
                raise ValueError(f"a record of arrays must have at most 63 bits, not {self.width}")
            word |= (raw & (1 << fmt.width) - 1) << self.offsets[name]
        return word

    def unpack(self, word) -> dict:
        """Return the fields of ``word`` by name: of an int or an integer array their values, of a hardware value its
        slices, signed where the format is."""
        return {name: self.field(name, word) for name in self}

    def field(self, name: str, word):
        """Return one field of ``word``, as `unpack` does."""
        fmt, low = self[name], self.offsets[name]
        if isinstance(word, INTEGERS):
            return fmt.from_bits(word >> low)
        bits = word[low : low + fmt.width]
        return bits.as_signed() if fmt.signed else bits


def _checked(name: str, fmt: Q, value):
    """``value`` as an int or an int64 array within the range of ``fmt``."""
    raw = np.asarray(value)
    outside = (raw < fmt.raw_min) | (raw > fmt.raw_max)
    if outside.any():
        worst = raw[outside][0]
        raise ValueError(f"{name} must be within {fmt.raw_min} and {fmt.raw_max} ({fmt}), not {worst}")
    return raw.astype(np.int64) if raw.ndim else int(raw)
