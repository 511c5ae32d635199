"""On a terminal of 16 colours what is well, what is not and what is neither stay apart."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from rich.color import ColorSystem
from textual.pilot import Pilot

from launcher.status import NodeState
from tests.tui.app_runs import opened
from tests.tui.recorded import RecordedOpener
from tui.app import DeckApp
from tui.deck.nodes_table import NodesTable
from tui.themes import CYCLE


@pytest.fixture(autouse=True)
def _asked(monkeypatch: pytest.MonkeyPatch) -> None:
    """The environment alone says how many colours there are."""
    monkeypatch.setattr("textual.constants.COLOR_SYSTEM", "auto")
    monkeypatch.delenv("COLORTERM", raising=False)


def inks(app: DeckApp) -> Iterator[tuple[str, int | None]]:
    """Yield each text of the table of nodes, and which of the 16 colours it is written in."""
    table = app.screen.query_one(NodesTable)
    for y in range(table.size.height):
        for segment in table.render_line(y):
            if segment.style is not None and segment.style.color is not None:
                colour = segment.style.color.downgrade(ColorSystem.STANDARD)
                yield segment.text.strip(), colour.number


async def shown(app: DeckApp, pilot: Pilot[int], theme: str) -> dict[str, int | None]:
    """Return the colours of words of the table in this theme."""
    app.theme = theme
    await pilot.pause()
    await pilot.pause()
    return dict(inks(app))


@pytest.mark.parametrize("terminal", ["xterm", "linux"])
async def test_good_bad_and_plain_words_have_colours_of_their_own(
    terminal: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("TERM", terminal)
    opener = RecordedOpener()
    async with opened(opener) as (app, pilot):
        assert app.console.color_system == "standard"
        opener.link.set_state("camera", NodeState.FAILED)
        opener.link.set_state("audio", NodeState.BACKOFF)
        for theme in CYCLE:
            ink = await shown(app, pilot, theme)
            words = [
                next(colour for text, colour in ink.items() if text.startswith(word))
                for word in ("● ready", "↻ restarts", "✗ failed", "ai_brain")
            ]
            assert len(set(words)) == 4, (theme, words)

            assert words[0] in {2, 10}, theme
            assert words[2] in {1, 9}, theme
