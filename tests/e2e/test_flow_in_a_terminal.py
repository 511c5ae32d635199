"""The timeline with real nodes: a typed command and a voice, followed to the wheels."""

from __future__ import annotations

import re
import time
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

import pytest

from tests.e2e.conftest import Deck
from tests.unit.profile_files import written
from tui.flow.chains import BURST_S

pytestmark = pytest.mark.nightly

PROFILE = """
    extends: 09-brain
    nodes: {camera: null, head_controller: null}
    panels: [voice]
"""
"""A picture has nothing to do with it, and takes as long to draw as all the rest."""

ROW = re.compile(r"^\s*([\d.]+) ms\s+(/?\w[\w/]*)", re.MULTILINE)


def steps_of(screen: str, words: str) -> list[tuple[float, str]]:
    """Delay in ms and source of each step of the chain whose headline has these words."""
    _before, _headline, after = screen.partition(f"“{words}")
    block = re.split(r"[▾▸] \d\d:\d\d:\d\d", after)[0]
    return [(float(delay), source) for delay, source in ROW.findall(block.split("─" * 20)[0])]


def has(*sources: str, words: str) -> Callable[[str], bool]:
    return lambda screen: {*sources} <= {source for _delay, source in steps_of(screen, words)}


def leads_through(*sources: str, words: str) -> Callable[[str], bool]:
    """Whether the chain has these sources in this order, others and repetitions between them."""

    def follows(screen: str) -> bool:
        steps = iter(source for _delay, source in steps_of(screen, words))
        return all(name in steps for name in sources)

    return follows


def assert_rising(steps: list[tuple[float, str]]) -> None:
    delays = [delay for delay, _source in steps]
    assert all(early <= late for early, late in pairwise(delays)), steps


def test_a_typed_command_and_a_voice_are_followed_to_the_wheels(deck: Deck, tmp_path: Path) -> None:
    profile = written(tmp_path, PROFILE)
    terminal = deck.open(str(profile), "--lang", "en", columns=200, rows=60)
    terminal.wait_for("7/7")
    terminal.press("6")
    voice = ("/audio/mic_raw", "ai_brain", "/ai_command", "/drive", "/audio/speaker_raw")
    terminal.wait_until(has(*voice, words="VOICE"), "a voice")
    obeyed = ("/audio/mic_raw", "/ai_command", "/drive")
    screen = terminal.wait_until(leads_through(*obeyed, words="VOICE"), "a voice that drives")
    assert_rising(steps_of(screen, "VOICE"))
    # So soon after the brain's word another one on the same topic is one with it.
    seen_s = time.monotonic()
    terminal.wait_until(lambda _screen: time.monotonic() - seen_s > BURST_S, "the end of a burst")
    terminal.press("1")
    terminal.wait_for("Voice")
    terminal.press("c")
    terminal.wait_for("^x STOP")
    terminal.type("left\r")
    terminal.wait_for('Heard "left"')
    terminal.press("escape")
    terminal.wait_for("space STOP")
    terminal.press("6")
    driven = ("/ai_command", "/drive", "/drive_safe", "/wheel_commands")
    # The wheels are commanded all the time, also between the command and its passing the gate.
    screen = terminal.wait_until(leads_through(*driven, words="left”"), "a typed command")
    assert_rising(steps_of(screen, "left”"))
    assert "a person" in screen
