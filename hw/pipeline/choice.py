"""A pipelined multiplexer: four words at a time, with a register after each choice."""

from amaranth.hdl import Array, Module, Signal

from hw.pipeline.delay import DelayLines

BITS = 2
WAYS = 1 << BITS


def choose(m: Module, lines: DelayLines, words: list, index, *, cycles: int, name: str, ahead: int = 0) -> Signal:
    """Return ``words[index]``, ``cycles`` after the words and ``ahead + cycles`` after the index. An index that is too
    large gives any of the words.

    Raises
    ------
    ValueError
        If there are too many words for so many cycles.
    """
    if len(words) > WAYS**cycles:
        raise ValueError(f"words must be at most {WAYS**cycles} to choose from in {cycles} cycles, not {len(words)}")
    for level in range(cycles):
        groups = [words[first : first + WAYS] for first in range(0, len(words), WAYS)]
        if len(words) > 1:
            way = lines.later(index[BITS * level : BITS * (level + 1)], ahead + level, name=f"{name}_select{level}")
        words = []
        for number, group in enumerate(groups):
            chosen = Signal(max(map(len, group)), name=f"{name}_mux{level}_{number}", reset_less=True)
            m.d.sync += chosen.eq(Array(group)[way] if len(group) > 1 else group[0])
            words.append(chosen)
    return words[0]
