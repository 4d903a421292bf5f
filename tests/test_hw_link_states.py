"""A component lists its states by path, because they tell its time: a state on no path is an error."""

import pytest
from hw_objects import refused

from hw.link.states import check_states


@pytest.mark.parametrize("paths", [[("idle", "go", "end")], [("idle",), ("go", "end")]])
def test_the_states_are_those_of_the_paths(paths):
    check_states(["idle", "end", "go"], *paths)


@pytest.mark.parametrize("states", [["idle", "go", "end", "more"], ["idle"]])
def test_another_state_is_refused(states):
    wrong = "more" if "more" in states else "end, go"
    message = f"the states of a machine must be those of its paths, not differ in {wrong}"
    refused(lambda: check_states(states, ("idle", "go"), ("end",)), message)
