"""Whatever text a robot brings, no screen gives it to the terminal: one screen and the last look.

`text.plain`, by which widgets make it harmless themselves, is tested in `tests/unit/text`.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from rich.segment import Segment
from textual.color import Color
from textual.drivers.headless_driver import HeadlessDriver
from textual.events import Paste

from graph.data import Trouble
from tests.hostile_text import EVIL, harm_in, harm_on_screen, poisoned
from tests.tui.recorded import TOPICS, RecordedGraph, RecordedOpener, lesson_samples, lesson_update
from tests.tui.snapshots import LESSON_9, settle
from tui.app import DeckApp
from tui.terminal.harmless import Harmless


class Writing(HeadlessDriver):
    """Keeps what a terminal would be given."""

    def __init__(self, *args: Any, **more: Any) -> None:
        super().__init__(*args, **more)
        self.written: list[str] = []

    @property
    def is_headless(self) -> bool:
        return False

    def write(self, data: str) -> None:
        self.written.append(data)


def test_the_last_look_replaces_what_steers_a_terminal_and_keeps_the_width() -> None:
    line = [Segment(f"{EVIL} 日本"), Segment("plain")]
    before = sum(segment.cell_length for segment in line)
    shown = Harmless().apply(line, Color(0, 0, 0))
    assert not harm_in("".join(segment.text for segment in shown).encode("utf-8", "surrogatepass"))
    assert sum(segment.cell_length for segment in shown) == before
    assert shown[1] is line[1]


async def test_a_screen_shows_it_as_text_and_goes_on(monkeypatch: pytest.MonkeyPatch) -> None:
    """Names, types, peers, messages and what is pasted into a field: as text, markup and all."""
    monkeypatch.setenv("TERM", "xterm-256color")
    troubled = [
        replace(row, trouble=trouble, name=f"/{trouble.name}") for row, trouble in zip(TOPICS, Trouble, strict=False)
    ]
    rows = sorted((*TOPICS, *map(poisoned, (*TOPICS, *troubled))), key=lambda row: row.name)
    samples = {poisoned(name): tuple(map(poisoned, ones)) for name, ones in lesson_samples().items()}
    update = lesson_update(topics=tuple(rows), samples={**lesson_samples(), **samples})
    opener = RecordedOpener(graph=RecordedGraph(update))
    app = DeckApp(opener, LESSON_9, "topics", driver_class=Writing)
    async with app.run_test(headless=False, size=(160, 50)) as pilot:
        await settle(pilot)
        await pilot.press("a", *(("down", "e", "V", "y", "e") * 5), "slash")
        app.post_message(Paste(EVIL.replace("\n", "")))
        await pilot.pause()
        await pilot.press("escape", "space")
        await settle(pilot)
        assert app.emergency.state.engaged
        assert isinstance(app._driver, Writing)
        written = "".join(app._driver.written)
    assert "evil" in written
    assert not harm_on_screen(written)
