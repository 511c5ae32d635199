"""Frames of the ToF sonars: the maker's own, what they mean, and what noise makes of them."""

from __future__ import annotations

import math
import random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot.wire.tfluna import SIZE, Model, TofDecoder, TofFrame, decode, encode
from tests.unit.streams import cut, flipped, noise

frames = st.builds(
    TofFrame, st.integers(0, 65535), st.integers(0, 65535), st.integers(0, 65535).map(lambda raw: raw / 8 - 256)
)
GOOD = TofFrame(123, 1000, 25.0)


@pytest.mark.parametrize(
    ("octets", "frame"),
    [
        ("59 59 7B 00 E8 03 C8 08 E8", GOOD),
        ("59 59 00 00 32 00 F0 08 DC", TofFrame(0, 50, 30.0)),
        ("59 59 FF FF 50 00 F0 08 F8", TofFrame(65535, 80, 30.0)),
        ("59 59 FE FF FF FF 60 09 16", TofFrame(65534, 65535, 44.0)),
        ("59 59 FC FF F4 01 60 09 0B", TofFrame(65532, 500, 44.0)),
    ],
)
def test_the_frames_of_the_maker(octets: str, frame: TofFrame) -> None:
    assert decode(bytes.fromhex(octets)) == frame
    assert encode(frame) == bytes.fromhex(octets)


@pytest.mark.parametrize(
    ("model", "distance_cm", "strength", "metres"),
    [
        (Model.LUNA, 123, 1000, 1.23), (Model.LUNA, 0, 50, math.inf),
        (Model.LUNA, 150, 99, math.nan), (Model.LUNA, 150, 100, 1.5),
        (Model.LUNA, 0, 65535, math.nan), (Model.LUNA, 100, 65535, math.nan),
        (Model.LUNA, 0, 1000, math.nan), (Model.LUNA, 19, 1000, -math.inf),
        (Model.LUNA, 20, 1000, 0.2), (Model.LUNA, 800, 1000, 8.0),
        (Model.LUNA, 801, 1000, math.inf), (Model.MINI_S, 65535, 80, math.inf),
        (Model.MINI_S, 65534, 65535, math.nan), (Model.MINI_S, 65532, 500, math.nan),
        (Model.MINI_S, 0, 500, math.nan), (Model.MINI_S, 9, 500, -math.inf),
        (Model.MINI_S, 1200, 500, 12.0),
    ],
)  # fmt: skip
def test_what_a_frame_means(model: Model, distance_cm: int, strength: int, metres: float) -> None:
    told = TofFrame(distance_cm, strength, 25.0).distance_m(model)
    assert told == metres or (math.isnan(told) and math.isnan(metres))


@given(frames, st.sampled_from(Model))
def test_a_distance_is_inside_of_the_range_or_says_why_not(frame: TofFrame, model: Model) -> None:
    metres = frame.distance_m(model)
    assert not math.isfinite(metres) or model.range_m[0] <= metres <= model.range_m[1]
    assert decode(encode(frame)) == frame


@pytest.mark.parametrize("frame", [TofFrame(-1, 0, 0), TofFrame(0, 65536, 0), TofFrame(0, 0, 1e6)])
def test_values_that_do_not_fit_are_refused(frame: TofFrame) -> None:
    with pytest.raises(ValueError, match="out of range"):
        encode(frame)


def test_no_turned_bit_makes_a_frame_and_the_next_ones_are_found() -> None:
    for bad in flipped(encode(GOOD), 1):
        decoder = TofDecoder()
        heard = decoder.feed(encode(GOOD) * 2 + bad + encode(GOOD) * 3)
        assert heard == [GOOD] * 5
        assert decoder.errors == 1
        assert decoder.skipped == SIZE


def test_two_turned_bits_pass_only_where_the_sum_cannot_tell() -> None:
    for bad in flipped(encode(GOOD), 2):
        told = decode(bad)
        assert told is None or (bad[:2] == b"YY" and sum(bad[:8]) % 256 == bad[8])


@given(noise, st.lists(frames, min_size=2, max_size=6), st.lists(st.integers(0, 400), max_size=20))
def test_frames_behind_noise_are_found_however_the_stream_is_cut(
    before: bytes, sent: list[TofFrame], places: list[int]
) -> None:
    decoder = TofDecoder()
    # Two frames' worth of what cannot begin one keep the noise from reaching into them.
    stream = before + bytes(2 * SIZE) + b"".join(map(encode, sent))
    heard = [frame for piece in cut(stream, places) for frame in decoder.feed(piece)]
    assert heard[-len(sent) :] == sent
    assert decoder.frames * SIZE + decoder.skipped + len(decoder._rest) == len(stream)


@given(st.lists(st.binary(max_size=300)))
def test_noise_never_raises_and_is_not_kept(pieces: list[bytes]) -> None:
    decoder = TofDecoder()
    for piece in pieces:
        decoder.feed(piece)
    assert len(decoder._rest) < 2 * SIZE


def test_ten_megabytes_of_noise_hold_no_frame() -> None:
    """A decoder that believes every sum would have found one in them."""
    dice, decoder = random.Random(4), TofDecoder()
    heard = [frame for _ in range(160) for frame in decoder.feed(dice.randbytes(65536))]
    assert heard == []
    assert decoder.feed(bytes(9) + encode(GOOD) * 2) == [GOOD, GOOD]


def test_a_payload_full_of_heads_is_got_through() -> None:
    sly = TofFrame(0x5959, 0x5959, 0x5959 / 8 - 256)
    decoder = TofDecoder()
    stream = b"".join(encode(frame) for frame in [sly, GOOD] * 20)
    assert decoder.feed(stream[3:])[-10:] == [sly, GOOD] * 5
