"""The talk: text of the lessons, PCM of a real microphone, and bytes that are neither."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from graph.data import GraphUpdate, Sample, TopicRow
from tests.tui.panel_stage import alone, rows
from tests.tui.recorded import NOW_S, lesson_update, sample, topic
from tui.panels.voice import VoicePanel, VoiceView, heard, level_line

MICROPHONE, LEVEL = "/audio/mic_raw", "/audio/level"


def tone(seconds: float, amplitude: float, rate: int = 16_000) -> bytes:
    times = np.arange(int(seconds * rate)) / rate
    return (amplitude * 32767 * np.sin(2 * math.pi * 440 * times)).astype("<i2").tobytes()


def test_sound_is_told_by_length_and_loudness() -> None:
    loud, quiet = heard(tone(0.5, 0.9)), heard(tone(0.5, 0.01))
    assert loud.words.startswith("PCM 0.5 s ")
    assert loud.levels > quiet.levels
    assert heard(bytes(16_000)).levels == "▁" * 8
    assert heard(tone(1.0, 0.5) + b"\x7f").seconds == pytest.approx(1.0)


@given(st.binary(max_size=400))
def test_whatever_comes_can_be_shown(data: bytes) -> None:
    words = heard(data).words
    assert words.isprintable() or "\u200d" in words
    words.encode("utf-8")


@pytest.mark.parametrize(
    ("dbfs", "width", "shown"),
    [
        (-30.0, 35, "microphone ████████········  -30 dB"),
        (-120.0, 35, "microphone ················ -120 dB"),
        (0.0, 24, "████████████████    0 dB"),
        (-30.0, 13, "-30 dB"),
        (None, 34, "no microphone"),
        (None, 8, "no micr…"),
    ],
)
def test_the_level_is_a_bar_and_a_number(dbfs: float | None, width: int, shown: str) -> None:
    line = level_line(dbfs, width)
    assert "".join(ink.text for ink in line) == shown
    assert sum(len(ink.text) for ink in line) <= width


def fed(*rows: TopicRow, samples: tuple[Sample, ...] = ()) -> GraphUpdate:
    update = lesson_update()
    return replace(update, topics=rows, samples={one.topic: (one,) for one in samples})


async def test_words_that_were_recognised_are_the_humans() -> None:
    panel = VoicePanel()
    words = sample("/audio/heard", "std_msgs/msg/String", {"data": "robot, stop"})
    row = topic("/audio/heard", "std_msgs/msg/String", 0.1)
    assert row.name in panel.followed()
    async with alone(panel, 50, 8).run_test(size=(60, 20)):
        panel.show(fed(row, samples=(words,)))
        (line,) = [line for line in rows(panel.query_one(VoiceView)) if "robot, stop" in line]
        assert "human" in line


async def test_the_microphone_is_told_by_its_level_or_by_its_absence() -> None:
    panel = VoicePanel()
    told = sample(LEVEL, "std_msgs/msg/Float32", {"data": -30.0})
    level = topic(LEVEL, "std_msgs/msg/Float32", 10.0)
    microphone = topic(MICROPHONE, "std_msgs/msg/ByteMultiArray", 10.0)
    async with alone(panel, 50, 8).run_test(size=(60, 20)):
        talk = panel.query_one(VoiceView)

        def shown(*rows_: TopicRow, samples: tuple[Sample, ...] = ()) -> str:
            panel.show(fed(*rows_, samples=samples))
            return "\n".join(rows(talk))

        assert "nobody publishes" in shown()
        assert "-30 dB" in shown(level, microphone, samples=(told,))
        assert "nobody has said anything yet" in shown(level, microphone)
        assert "no microphone" in shown(replace(level, age_s=2.5), microphone)
        talk.hear("robot", b"hello", NOW_S)
        bare = shown(microphone)
        assert "no microphone" not in bare, "the course's own tells no level"
        assert "no microphone" in shown()
        assert "hello" in shown()


async def test_of_a_phrase_that_does_not_fit_its_beginning_is_shown() -> None:
    panel = VoicePanel()
    async with alone(panel, 40, 4).run_test(size=(50, 10)):
        view = panel.query_one(VoiceView)
        view.hear("human", b"have a look round and tell me what is there, please", NOW_S)
        view.hear("robot", b"I look round", NOW_S)
        shown = [line.strip() for line in rows(view)]
        assert any("human have a look" in line for line in shown)
        assert "robot I look round" in shown[-1]
