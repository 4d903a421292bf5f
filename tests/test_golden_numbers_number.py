"""All number types have the operations of the protocol, with the same arguments."""

import inspect
from collections import Counter
from typing import Protocol

import numpy as np
import pytest

from golden.numbers.graph import Graph, Operation
from golden.numbers.number import Number
from golden.numbers.qarray import QArray
from golden.numbers.qformat import Q

NUMBERS = {"QArray": QArray(np.zeros(1, np.int64), Q(1, 3), Counter()), "Operation": Graph().input("x", Q(1, 3))}
NEEDED = {"__add__", "__radd__", "__sub__", "__rsub__", "__mul__", "__abs__", "__lt__"}
NEEDED |= {"total", "select", "scale", "field", "lead", "to", "fault"}


@pytest.mark.parametrize("number", NUMBERS.values(), ids=NUMBERS)
def test_each_number_type_is_a_number(number):
    assert isinstance(number, Number) and number.fmt == Q(1, 3)


@pytest.mark.parametrize("name", sorted(NEEDED))
def test_an_operation_takes_the_same_arguments_in_every_number_type(name):
    asked = inspect.signature(getattr(Number, name)).parameters
    for kind in (QArray, Operation):
        offered = inspect.signature(getattr(kind, name)).parameters
        assert list(offered) == list(asked), kind
        assert [p.default for p in offered.values()] == [p.default for p in asked.values()], kind
        assert isinstance(inspect.getattr_static(kind, name), staticmethod) == isinstance(
            inspect.getattr_static(Number, name), staticmethod
        )


def test_every_operation_of_the_protocol_is_looked_at_here():
    members = {name for name, member in vars(Number).items() if name not in vars(Protocol) and name[-2:] != "__"}
    operators = {name for name in vars(Number) if name in vars(int) and name not in vars(object)}
    assert {name for name in members if not name.startswith("_")} | operators | {"__lt__"} == NEEDED | {"fmt"}


@pytest.mark.parametrize("missing", sorted(NEEDED - {"__lt__"}))  # which every object has
def test_a_type_that_lacks_one_is_no_number(missing):
    members = {name: getattr(QArray, name) for name in NEEDED - {missing}}
    incomplete = type("Incomplete", (), {"fmt": Q(1, 3), **members})()
    assert not isinstance(incomplete, Number)
