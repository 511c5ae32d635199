"""Loudness, sample rates, and the difference between words and sound."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot.sound import (
    SILENCE_DBFS,
    TEXT_READ,
    LevelMeter,
    Resampler,
    level_dbfs,
    mock_level_dbfs,
    samples_of,
    text_in,
)


def tone(hz: float, seconds: float, rate_hz: int, amplitude: float = 0.5) -> bytes:
    times = np.arange(round(seconds * rate_hz)) / rate_hz
    wave = amplitude * 32767 * np.sin(2 * math.pi * hz * times)
    return np.rint(wave).astype("<i2").tobytes()


@pytest.mark.parametrize(
    ("amplitude", "dbfs"), [(1.0, -3.01), (0.5, -9.03), (0.1, -23.0), (0.001, -63.0)]
)
def test_the_level_of_a_tone(amplitude: float, dbfs: float) -> None:
    assert level_dbfs(tone(440, 1.0, 16_000, amplitude)) == pytest.approx(dbfs, abs=0.05)


def test_full_scale_is_0_and_nothing_is_the_least() -> None:
    assert level_dbfs(b"\x00\x80" * 100) == pytest.approx(0.0)
    assert level_dbfs(bytes(3200)) == level_dbfs(b"") == level_dbfs(b"\x01") == SILENCE_DBFS


@given(st.binary(max_size=300))
def test_the_level_of_any_bytes_is_a_number_in_its_range(data: bytes) -> None:
    assert SILENCE_DBFS <= level_dbfs(data) <= 0.0


def test_the_meter_forgets_what_is_older_than_a_tenth_of_a_second() -> None:
    meter = LevelMeter(16_000)
    assert meter.dbfs == SILENCE_DBFS
    meter.feed(tone(440, 2.0, 16_000))
    assert meter.dbfs == pytest.approx(-9.03, abs=0.05)
    meter.feed(bytes(1600))
    assert meter.dbfs == pytest.approx(-12.04, abs=0.05)
    meter.feed(bytes(1600))
    assert meter.dbfs == SILENCE_DBFS


@pytest.mark.parametrize(
    ("from_hz", "to_hz"), [(48_000, 16_000), (44_100, 16_000), (16_000, 48_000), (16_000, 44_100)]
)
def test_a_tone_keeps_its_pitch_length_and_loudness(from_hz: int, to_hz: int) -> None:
    made = Resampler(from_hz, to_hz).feed(tone(440, 1.0, from_hz))
    samples = samples_of(made).astype(np.float64)
    assert len(samples) == pytest.approx(to_hz, abs=3)
    spectrum = np.abs(np.fft.rfft(samples))
    assert int(np.argmax(spectrum)) * to_hz / len(samples) == pytest.approx(440, abs=1)
    assert level_dbfs(made) == pytest.approx(-9.03, abs=0.1)


def test_the_way_down_softens_tones_that_would_come_out_false() -> None:
    false = Resampler(48_000, 16_000).feed(tone(13_000, 1.0, 48_000))
    assert level_dbfs(false) < -18.0


@given(
    st.binary(min_size=2, max_size=600).filter(lambda data: len(data) % 2 == 0),
    st.lists(st.integers(0, 300), max_size=6),
    st.sampled_from([(48_000, 16_000), (44_100, 16_000), (16_000, 44_100), (8_000, 8_000)]),
)
def test_other_blocks_make_no_other_sound(
    data: bytes, cuts: list[int], rates: tuple[int, int]
) -> None:
    places = [0, *sorted(2 * cut for cut in cuts), len(data)]
    pieces = Resampler(*rates)
    in_pieces = b"".join(pieces.feed(data[begin:end]) for begin, end in pairwise(places))
    assert in_pieces == Resampler(*rates).feed(data)


def test_the_same_rate_changes_nothing() -> None:
    sound = tone(440, 0.5, 16_000)
    assert Resampler(16_000, 16_000).feed(sound) == sound


def test_a_long_stream_does_not_drift() -> None:
    resampler = Resampler(44_100, 16_000)
    made = sum(len(resampler.feed(bytes(2 * 4410))) for _ in range(600)) // 2
    assert made == pytest.approx(60 * 16_000, abs=2)


def test_a_rate_that_is_none_is_refused() -> None:
    with pytest.raises(ValueError, match="above 0 Hz"):
        Resampler(0, 16_000)


def test_words_are_told_from_sound() -> None:
    assert text_in("Осмотрись".encode()) == "Осмотрись"
    assert text_in(b"") == ""
    assert text_in(bytes(3200)) is None
    assert text_in(tone(440, 0.1, 16_000)) is None
    assert text_in(b"\xff\xfe\x00") is None
    assert text_in("ж".encode() * 1_000_000) == "ж" * (TEXT_READ // 2)
    assert text_in(b"a" + "ж".encode() * 1_000_000) == "a" + "ж" * (TEXT_READ // 2 - 1)


def test_a_mock_voice_is_loud_while_it_speaks() -> None:
    levels = [mock_level_dbfs("a phrase of thirty letters, so", at / 10) for at in range(40)]
    assert all(level > -35 for level in levels[:20])
    assert len({round(level) for level in levels[:20]}) > 2
    assert all(level < -50 for level in levels[21:])
    assert mock_level_dbfs("", math.inf) < -50
