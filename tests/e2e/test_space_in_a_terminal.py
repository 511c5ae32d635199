"""The Space screen in a real terminal: a map is seen, and a goal aimed at it is heard."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from tests.e2e.conftest import Deck
from tests.unit.profile_files import written

pytestmark = pytest.mark.nightly

ROOT = Path(__file__).parents[2]
PROFILE = f"""
    title: {{en: A map}}
    nodes:
      room:
        exec: [{sys.executable}, -m, tests.e2e.room_with_a_goal]
        cwd: {ROOT}
        ready: {{topic: /map}}
"""
ALT_G, ALT_V = "\x1bg", "\x1bv"


def test_a_goal_is_aimed_at_a_map(deck: Deck, tmp_path: Path) -> None:
    terminal = deck.open(str(written(tmp_path, PROFILE)), "--lang", "en")
    terminal.wait_for("1/1")
    terminal.press("9")
    terminal.wait_until(lambda text: "/map" in text and "in hall" in text, "the map")
    # As one that is held, over a slow line.
    terminal.type(ALT_V + ALT_V)
    terminal.wait_for("perspective")
    assert "The robot in 3D" not in terminal.text()
    terminal.press("home")
    terminal.type(ALT_V)
    terminal.wait_for("from above")
    terminal.type(ALT_G)
    terminal.wait_for("GOAL → /goal_pose (room)")
    terminal.press("right")
    terminal.press("enter")
    terminal.wait_for("Published on /goal_pose")
    terminal.press("4")
    terminal.wait_for("goal in hall, facing 0 degrees")
