"""Records give back the fields they were packed from: of ints, arrays and hardware values."""

import numpy as np
import pytest
from amaranth.hdl import Module, Signal
from amaranth.sim import Simulator
from integer_objects import random_raw

from golden.numbers.qformat import BIT, Q, unsigned
from golden.numbers.record import Record

RECORD = Record({"index": unsigned(5, 0), "shift": Q(4, 0), "valid": BIT, "ratio": Q(2, 10)})
LARGEST = {name: fmt.raw_max for name, fmt in RECORD.items()}
SMALLEST = {name: fmt.raw_min for name, fmt in RECORD.items()}


def test_a_record_is_a_mapping_in_the_order_of_its_fields():
    assert list(RECORD) == ["index", "shift", "valid", "ratio"] and RECORD["shift"] == Q(4, 0)
    assert RECORD == dict(RECORD.items()) and len(RECORD) == 4


def test_the_first_field_is_lowest_and_there_are_no_gaps():
    assert RECORD.offsets == {"index": 0, "shift": 5, "valid": 9, "ratio": 10} and RECORD.width == 22
    assert RECORD.pack({"index": 1, "shift": 1, "valid": 1, "ratio": 1}) == 0b1_1_0001_00001


@pytest.mark.parametrize("values", [LARGEST, SMALLEST, {"index": 7, "shift": -3, "valid": 1, "ratio": -1000}])
def test_an_int_gives_back_the_fields_that_it_was_packed_from(values):
    word = RECORD.pack(values)
    assert 0 <= word < 1 << RECORD.width and RECORD.unpack(word) == values


def test_bits_above_the_record_change_no_field():
    assert RECORD.unpack(RECORD.pack(LARGEST) | 0b101 << RECORD.width) == LARGEST
    assert RECORD.field("index", RECORD.pack(LARGEST) | 1 << RECORD.width) == LARGEST["index"]


def test_arrays_are_packed_and_unpacked_like_ints():
    rng = np.random.default_rng(1)
    values = {name: random_raw(rng, fmt, (3, 40)) for name, fmt in RECORD.items()}
    words = RECORD.pack(values)
    assert words.dtype == np.int64 and words.shape == (3, 40)
    for name, column in RECORD.unpack(words).items():
        assert np.array_equal(column, values[name]), name
    for place in np.ndindex(words.shape):
        assert RECORD.pack({name: column[place] for name, column in values.items()}) == words[place]


def test_a_hardware_value_gives_slices_that_are_signed_where_the_format_is():
    word = Signal(RECORD.width)
    fields = RECORD.unpack(word)
    for name, bits in fields.items():
        assert bits.shape().width == RECORD[name].width and bits.shape().signed == RECORD[name].signed, name

    async def bench(ctx):
        ctx.set(word, RECORD.pack(SMALLEST))
        assert {name: ctx.get(bits) for name, bits in fields.items()} == SMALLEST

    simulator = Simulator(Module())
    simulator.add_testbench(bench)
    simulator.run()


def test_the_fields_with_a_prefix_are_a_record_of_their_own():
    record = Record({"rho_value": unsigned(0, 6), "sigma_value": unsigned(0, 7), "sigma_shift": unsigned(5, 0)})
    assert record.starting_with("sigma").offsets == {"sigma_value": 0, "sigma_shift": 7}


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("index", 32, r"index must be within 0 and 31 \(UQ5.0\), not 32"),
        ("index", -1, r"index must be within 0 and 31 \(UQ5.0\), not -1"),
        ("shift", -9, r"shift must be within -8 and 7 \(Q4.0\), not -9"),
        ("index", 1 << 70, rf"index must be within 0 and 31 \(UQ5.0\), not {1 << 70}"),
        ("shift", np.array([0, 3, 8]), r"shift must be within -8 and 7 \(Q4.0\), not 8"),
    ],
)
def test_a_value_that_does_not_fit_is_refused(name, value, message):
    with pytest.raises(ValueError, match=message):
        RECORD.pack(SMALLEST | {name: value})


def test_arrays_of_words_that_do_not_fit_an_int64_are_refused():
    wide = Record({"low": unsigned(40, 0), "high": unsigned(24, 0)})
    assert wide.pack({"low": 0, "high": 1}) == 1 << 40
    with pytest.raises(ValueError, match="a record of arrays must have at most 63 bits, not 64"):
        wide.pack({"low": np.zeros(2, np.int64), "high": np.zeros(2, np.int64)})
