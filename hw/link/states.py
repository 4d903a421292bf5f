"""Paths through a state machine, one clock cycle a state unless a component says that a state waits."""

from collections.abc import Iterable

Path = tuple[str, ...]


def check_states(states: Iterable[str], *paths: Path) -> None:
    """Raise ValueError unless a machine has the states of its component's paths, which tell its time, and no others."""
    states, named = set(states), {state for path in paths for state in path}
    if named != states:
        wrong = ", ".join(sorted(named ^ states))
        raise ValueError(f"the states of a machine must be those of its paths, not differ in {wrong}")
