"""The talk: text of the lessons, PCM of a real microphone, and bytes that are neither."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.tui.panel_stage import Stage, alone, rows
from tests.tui.recorded import NOW_S
from tests.tui.snapshots import SnapCompare
from tui.i18n import set_language
from tui.widgets.voice import VoicePanel
from tui.widgets.voice_reading import heard


def tone(seconds: float, amplitude: float, rate: int = 16_000) -> bytes:
    times = np.arange(int(seconds * rate)) / rate
    return (amplitude * 32767 * np.sin(2 * math.pi * 440 * times)).astype("<i2").tobytes()


def test_text_is_shown_as_text() -> None:
    assert heard(b"VOICE_COMMAND: Look around").words == "VOICE_COMMAND: Look around"
    assert heard("Осмотрись\nи расскажи".encode()).words == "Осмотрись и расскажи"


def test_sound_is_told_by_length_and_loudness() -> None:
    loud, quiet = heard(tone(0.5, 0.9)), heard(tone(0.5, 0.01))
    assert loud.words.startswith("PCM 16-bit, 0.5 s, level ")
    assert loud.levels > quiet.levels
    assert heard(bytes(16_000)).levels == "▁" * 8
    assert heard(tone(1.0, 0.5) + b"\x7f").seconds == pytest.approx(1.0)


def test_a_few_odd_bytes_are_shown_as_such() -> None:
    assert heard(b"\xff\xfe\x00").words == "3 bytes, no text: ff fe 00"
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
    panel = VoicePanel()
    async with alone(panel, 50, 5).run_test(size=(60, 20)):
        for number in range(300):
            panel.hear("human" if number % 2 else "robot", f"word {number}".encode(), NOW_S)
        shown = rows(panel)
        assert "word 299" in shown[-1]
        assert "human" in shown[-1]
        assert "robot" in shown[-2]
        assert "word 295" in shown[0]


async def test_a_stream_of_sound_is_one_entry_that_grows() -> None:
    panel = VoicePanel()
    async with alone(panel, 70, 5).run_test(size=(80, 20)):
        for number in range(20):
            panel.hear("human", tone(0.1, 0.5), NOW_S + number / 10)
        panel.hear("human", tone(0.1, 0.5), NOW_S + 30)
        shown = [row for row in rows(panel) if row]
        assert len(shown) == 2
        assert "2.0 s" in shown[0]
        assert "0.1 s" in shown[1]


async def test_silence_says_why() -> None:
    panel = VoicePanel()
    async with alone(panel, 50, 5).run_test(size=(60, 20)):
        assert "waiting for the first message" in "\n".join(rows(panel))
        panel.hear("human", b"hello", NOW_S)
        assert "hello" in "\n".join(rows(panel))
        panel.clear()
        assert "waiting" in "\n".join(rows(panel))


@pytest.mark.parametrize("language", ["en", "ru"])
def test_looks(language: str, snap_compare: SnapCompare, monkeypatch: pytest.MonkeyPatch) -> None:
    """Human and robot by name, sign and colour; text folded; sound as a line of levels."""
    import time

    monkeypatch.setenv("TZ", "UTC")
    time.tzset()
    set_language(language)
    panels = [VoicePanel() for _panel in range(3)]

    def fill() -> None:
        for panel in panels[:2]:
            panel.hear("human", b"VOICE_COMMAND: Look around and tell me what you see!", NOW_S)
            panel.hear("robot", "Еду вперёд и осматриваюсь".encode(), NOW_S + 2)
            panel.hear("human", b"\xff\xfe\x00\x01", NOW_S + 3)
            panel.hear("human", b"\x1b[31mred\x1b[0m [red]x[/red] and more text", NOW_S + 4)
            panel.hear("human", tone(0.5, 0.3), NOW_S + 5)
            panel.hear("human", tone(0.5, 0.01), NOW_S + 5.5)

    stage = Stage([(panels[0], (60, 10))], [(panels[1], (28, 10)), (panels[2], (28, 3))], fill=fill)
    assert snap_compare(stage, terminal_size=(94, 18), run_before=stage.filled)
