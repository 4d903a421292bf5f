"""Frames in software: a packed frame is unpacked again; a damaged one is refused by its kind."""

import pytest
from hw_objects import refused
from hypothesis import given
from hypothesis import strategies as st
from link_objects import KEY

from hw.link.frame import GREETING, PAYLOAD_MOST, Frame, FrameError, unpacked

BYTE = st.integers(0, 255)


@given(BYTE, BYTE, BYTE, st.binary(max_size=PAYLOAD_MOST))
def test_a_frame_comes_back(type_, seq, status, payload):
    frame = Frame(type_, seq, status, payload)
    packed = frame.packed(KEY)
    assert packed[0] == packed[-1] == 0 and 0 not in packed[1:-1]
    assert unpacked(packed[1:-1], KEY) == frame


def test_the_wire_format_is_pinned():
    assert Frame(2, 3, payload=b"\0a").packed(KEY).hex() == "00030203010202010661d1114fe500"


@pytest.mark.parametrize(
    ("coded", "kind"),
    [
        (b"\5abc", "cobs_errors"),
        (b"\2a", "length_errors"),
        (Frame(2, 0, payload=b"payload").packed(KEY)[1:-1][:-1] + b"\1", "crc_errors"),
        (Frame(2, 0).packed(bytes(8))[1:-1], "crc_errors"),
    ],
)
def test_bytes_that_are_no_frame_are_refused(coded, kind):
    with pytest.raises(FrameError, match=f"^{kind}$") as raised:
        unpacked(coded, KEY)
    assert raised.value.kind == kind


def test_a_greeting_needs_no_key():
    assert unpacked(Frame(GREETING, 9).packed(KEY)[1:-1], bytes(8)) == Frame(GREETING, 9)


def test_a_payload_that_is_too_long_is_refused():
    refused(lambda: Frame(2, 0, payload=bytes(513)).packed(KEY), "payload must be at most 512 bytes, not 513")
