"""Loudness, sample rates, and the difference between words and sound."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot.sound import SILENCE_DBFS, TEXT_READ, Resampler, level_dbfs, samples_of, text_in


def tone(hz: float, seconds: float, rate_hz: int, amplitude: float = 0.5) -> bytes:
    times = np.arange(round(seconds * rate_hz)) / rate_hz
    wave = amplitude * 32767 * np.sin(2 * math.pi * hz * times)
    return np.rint(wave).astype("<i2").tobytes()


@given(st.binary(max_size=300))
def test_the_level_of_any_bytes_is_a_number_in_its_range(data: bytes) -> None:
    assert SILENCE_DBFS <= level_dbfs(data) <= 0.0


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


@given(
    st.binary(min_size=2, max_size=600).filter(lambda data: len(data) % 2 == 0),
    st.lists(st.integers(0, 300), max_size=6),
    st.sampled_from([(48_000, 16_000), (44_100, 16_000), (16_000, 44_100), (8_000, 8_000)]),
)
def test_other_blocks_make_no_other_sound(data: bytes, cuts: list[int], rates: tuple[int, int]) -> None:
    places = [0, *sorted(2 * cut for cut in cuts), len(data)]
    pieces = Resampler(*rates)
    in_pieces = b"".join(pieces.feed(data[begin:end]) for begin, end in pairwise(places))
    assert in_pieces == Resampler(*rates).feed(data)


def test_words_are_told_from_sound() -> None:
    assert text_in("Осмотрись".encode()) == "Осмотрись"
    assert text_in(b"") == ""
    assert text_in(bytes(3200)) is None
    assert text_in(tone(440, 0.1, 16_000)) is None
    assert text_in(b"\xff\xfe\x00") is None
    assert text_in("ж".encode() * 1_000_000) == "ж" * (TEXT_READ // 2)
    assert text_in(b"a" + "ж".encode() * 1_000_000) == "a" + "ж" * (TEXT_READ // 2 - 1)
