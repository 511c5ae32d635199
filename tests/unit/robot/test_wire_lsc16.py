"""Frames of the servo controller: the maker's own, and that noise is none."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot.wire.lsc16 import (
    ActionComplete,
    ActionRun,
    ActionStop,
    Battery,
    BatteryRequest,
    ServoDecoder,
    ServoFrame,
    ServoMove,
    decode,
    encode,
)
from tests.unit.streams import cut, flipped, noise

MADE_BY_THE_MAKER: list[tuple[str, ServoFrame]] = [
    ("55 55 08 03 01 E8 03 01 D0 07", ServoMove(1000, ((1, 2000),))),
    ("55 55 0B 03 02 20 03 02 B0 04 09 FC 08", ServoMove(800, ((2, 1200), (9, 2300)))),
    ("55 55 02 0F", BatteryRequest()),
    ("55 55 04 0F 4C 1D", Battery(7500)),
    ("55 55 02 07", ActionStop()),
]
pairs = st.tuples(st.integers(1, 16), st.integers(500, 2500))
moves = st.lists(pairs, min_size=1, max_size=16, unique_by=lambda pair: pair[0]).map(tuple)
groups = st.integers(0, 255), st.integers(0, 65535)
frames: st.SearchStrategy[ServoFrame] = st.one_of(
    st.builds(ServoMove, st.integers(0, 30_000), moves),
    st.builds(ActionRun, *groups),
    st.builds(ActionComplete, *groups),
    st.builds(Battery, st.integers(0, 30_000)),
    st.sampled_from([ActionStop(), BatteryRequest()]),
)


@pytest.mark.parametrize(("octets", "frame"), MADE_BY_THE_MAKER)
def test_the_frames_of_the_maker(octets: str, frame: ServoFrame) -> None:
    assert encode(frame) == bytes.fromhex(octets)
    assert decode(bytes.fromhex(octets)) == frame


@pytest.mark.parametrize(
    "frame",
    [
        ServoMove(30_001, ((1, 1500),)), ServoMove(-1, ((1, 1500),)), ServoMove(100, ((1, 499),)),
        ServoMove(100, ((1, 2501),)), ServoMove(100, ((0, 1500),)), ServoMove(100, ((17, 1500),)),
        ServoMove(100, ((1, 1500), (1, 1600))), ServoMove(100, ()), Battery(30_001),
        ActionRun(256, 1),
    ],
)  # fmt: skip
def test_values_that_the_controller_does_not_know_are_refused(frame: ServoFrame) -> None:
    with pytest.raises(ValueError, match="out of range"):
        encode(frame)


def test_what_turned_bits_make_is_refused_or_at_least_in_its_range() -> None:
    """There is no checksum: all that can be promised is that no servo is sent astray."""
    for bad in flipped(encode(ServoMove(1000, ((1, 2000),))), 2):
        for frame in ServoDecoder().feed(bad + bytes(60)):
            assert encode(frame) in bad + bytes(60)


@given(noise, st.lists(frames, max_size=6), st.lists(st.integers(0, 400), max_size=20))
def test_frames_behind_noise_are_found_however_the_stream_is_cut(
    before: bytes, sent: list[ServoFrame], places: list[int]
) -> None:
    decoder = ServoDecoder()
    stream = before + bytes(60) + b"".join(map(encode, sent))
    heard = [frame for piece in cut(stream, places) for frame in decoder.feed(piece)]
    assert heard[len(heard) - len(sent) :] == sent
    assert decoder.skipped + sum(len(encode(frame)) for frame in heard) == len(stream)


@given(st.lists(st.binary(max_size=300) | st.just(b"\x55" * 90)))
def test_noise_never_raises_and_is_not_kept(pieces: list[bytes]) -> None:
    decoder = ServoDecoder()
    for piece in pieces:
        for frame in decoder.feed(piece):
            assert decode(encode(frame)) == frame
    assert len(decoder._rest) < 55
