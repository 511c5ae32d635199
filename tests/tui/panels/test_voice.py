"""The talk: text of the lessons, PCM of a real microphone, and bytes that are neither."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from graph.data import Sample, TopicRow, Trouble
from tests.tui.panel_stage import Stage, alone, rows
from tests.tui.recorded import NOW_S, lesson_update, sample, topic
from tests.tui.snapshots import SnapCompare
from text.i18n import set_language
from tui.panels.voice.panel import VoicePanel
from tui.panels.voice.reading import heard
from tui.panels.voice.widget import VoiceView, level_line

if TYPE_CHECKING:
    from graph.data import GraphUpdate

MICROPHONE, LEVEL = "/audio/mic_raw", "/audio/level"


def tone(seconds: float, amplitude: float, rate: int = 16_000) -> bytes:
    times = np.arange(int(seconds * rate)) / rate
    return (amplitude * 32767 * np.sin(2 * math.pi * 440 * times)).astype("<i2").tobytes()


def test_text_is_shown_as_text() -> None:
    assert heard(b"VOICE_COMMAND: Look around").words == "VOICE_COMMAND: Look around"
    assert heard("Осмотрись\nи расскажи".encode()).words == "Осмотрись и расскажи"


def test_sound_is_told_by_length_and_loudness() -> None:
    loud, quiet = heard(tone(0.5, 0.9)), heard(tone(0.5, 0.01))
    assert loud.words.startswith("PCM 0.5 s ")
    assert loud.levels > quiet.levels
    assert heard(bytes(16_000)).levels == "▁" * 8
    assert heard(tone(1.0, 0.5) + b"\x7f").seconds == pytest.approx(1.0)


def test_a_few_odd_bytes_are_shown_as_such() -> None:
    assert heard(b"\xff\xfe\x00").words == "3 bytes, not text: ff fe 00"
    assert heard(b"").words == "(an empty message)"
    assert heard(b"\x1b]52;c;AAAA\x07 harmless text that is long enough").words.startswith("␛]52")


def test_long_text_is_cut_even_in_the_middle_of_a_letter() -> None:
    assert len(heard("ж".encode() * 1_000_000).words) <= 2_000
    assert heard(b"a" + "ж".encode() * 1_000_000).words.startswith("aжж")


@given(st.binary(max_size=400))
def test_whatever_comes_can_be_shown(data: bytes) -> None:
    words = heard(data).words
    assert words.isprintable() or "\u200d" in words
    words.encode("utf-8")


async def test_the_newest_is_at_the_bottom_and_long_talk_drops_the_oldest() -> None:
    view = VoiceView()
    async with alone(view, 50, 5).run_test(size=(60, 20)):
        for number in range(300):
            view.hear("human" if number % 2 else "robot", f"word {number}".encode(), NOW_S)
        shown = rows(view)
        assert "word 299" in shown[-1]
        assert "human" in shown[-1]
        assert "robot" in shown[-2]
        assert "word 295" in shown[0]


async def test_one_line_tells_who_and_how_it_begins() -> None:
    view = VoiceView()
    async with alone(view, 30, 2).run_test(size=(60, 20)):
        view.hear("robot", b"I look round and drive on.", NOW_S)
        view.show_level(-30.0)
        talk, level = rows(view)
        assert talk == "◂ robot I look round and driv…"
        assert "-30 dB" in level


async def test_a_stream_of_sound_is_one_entry_that_grows() -> None:
    view = VoiceView()
    async with alone(view, 70, 5).run_test(size=(80, 20)):
        for number in range(20):
            view.hear("human", tone(0.1, 0.5), NOW_S + number / 10)
        view.hear("human", tone(0.1, 0.5), NOW_S + 30)
        shown = [row for row in rows(view) if row]
        assert len(shown) == 2
        assert "2.0 s" in shown[0]
        assert "0.1 s" in shown[1]


async def test_silence_says_why() -> None:
    view = VoiceView()
    async with alone(view, 50, 5).run_test(size=(60, 20)):
        assert "waiting for the first message" in "\n".join(rows(view))
        view.hear("human", b"hello", NOW_S)
        assert "hello" in "\n".join(rows(view))
        view.clear()
        assert "waiting" in "\n".join(rows(view))


@pytest.mark.parametrize("language", ["en", "ru"])
def test_looks(language: str, dump_compare: SnapCompare, monkeypatch: pytest.MonkeyPatch) -> None:
    """Human and robot by name, sign and colour; text folded; sound as a line of levels."""
    import time

    monkeypatch.setenv("TZ", "UTC")
    time.tzset()
    set_language(language)
    views = [VoiceView() for _view in range(3)]

    def fill() -> None:
        for view in views[:2]:
            view.hear("human", b"VOICE_COMMAND: Look around and tell me what you see!", NOW_S)
            view.hear("robot", "Еду вперёд и осматриваюсь".encode(), NOW_S + 2)
            view.hear("human", b"\xff\xfe\x00\x01", NOW_S + 3)
            view.hear("human", b"\x1b[31mred\x1b[0m [red]x[/red] and more text", NOW_S + 4)
            view.hear("human", tone(0.5, 0.3), NOW_S + 5)
            view.hear("human", tone(0.5, 0.01), NOW_S + 5.5)

    stage = Stage([(views[0], (60, 10))], [(views[1], (28, 10)), (views[2], (28, 3))], fill=fill)
    assert dump_compare(stage, terminal_size=(94, 18), run_before=stage.filled)


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


@pytest.mark.parametrize(
    ("dbfs", "look"), [(-70, "muted"), (-30, "good"), (-10, "warn"), (-1, "bad")]
)
def test_a_level_is_faint_good_loud_or_cut_off(dbfs: float, look: str) -> None:
    assert level_line(dbfs, 40)[-1].look == look


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
        assert "-30 dB" in shown(level, microphone), "a screen may be quicker than the level"
        assert "no microphone" in shown(replace(level, age_s=2.5), microphone)
        quiet = replace(level, age_s=None, trouble=Trouble.QUIET)
        assert "no microphone" in shown(quiet, microphone)
        assert "dB" in shown(level, microphone, samples=(told,))
        nan = replace(told, value={"data": math.nan})
        assert "-30 dB" in shown(level, microphone, samples=(nan,))
        talk.hear("robot", b"hello", NOW_S)
        bare = shown(microphone)
        assert "dB" not in bare
        assert "no microphone" not in bare, "the course's own tells no level"
        assert "no microphone" in shown()
        assert "hello" in shown()


@pytest.mark.parametrize("language", ["en", "ru"])
def test_levels_look(language: str, dump_compare: SnapCompare) -> None:
    """Faint grey, speech green, loud yellow, cut off red; none in words; narrow ones a number."""
    set_language(language)
    states = (-58.0, -24.0, -9.0, -2.0, None)
    wide, narrow = ([VoiceView() for _state in states] for _width in range(2))

    def fill() -> None:
        for views in (wide, narrow):
            for dbfs, view in zip(states, views, strict=True):
                view.show_level(dbfs, missing=dbfs is None)
                view.hear("human", b"Look!", NOW_S)

    stage = Stage(
        [(view, (44, 2)) for view in wide], [(view, (18, 2)) for view in narrow], fill=fill
    )
    assert dump_compare(stage, terminal_size=(70, 21), run_before=stage.filled)
