"""A screen at a size of the terminal and in a language, and when it is all there.

The recorded session and graph are those of `tests.tui.recorded`; the clock stands still, nothing
blinks, nothing is animated.
"""

from __future__ import annotations

from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from textual.app import App
from textual.pilot import Pilot

from tests.tui.recorded import RecordedOpener
from tests.waiting import until
from text.i18n import set_language
from tui.app import DeckApp
from tui.dialogs.dialog import Dialog
from tui.picker.screen import PickerScreen
from tui.session.requests import OpenRequest
from tui.widgets.rows import Rows

SnapCompare = Callable[..., bool]


@dataclass(frozen=True)
class Look:
    """One size and one language."""

    size: tuple[int, int]
    language: str

    def __str__(self) -> str:
        return f"{self.size[0]}x{self.size[1]}-{self.language}"

    def app(self, screen: str = "deck", opener: RecordedOpener | None = None) -> DeckApp:
        """Return an app with the recorded lesson 9 opened, that will show `screen`."""
        set_language(self.language)
        order = OpenRequest() if screen == "picker" else OpenRequest(Path("profiles/09-brain.yaml"))
        return DeckApp(opener or RecordedOpener(), order, screen)


NARROW, WIDE = Look((80, 24), "en"), Look((120, 40), "ru")


async def settle(pilot: Pilot[Any]) -> None:
    """Wait until the recorded session, the picker or a question is there and all is handled."""
    app = pilot.app
    assert isinstance(app, DeckApp)
    await pilot.pause()
    await until(lambda: app._exit or app.feed.update or _asks(app), "what was recorded")
    for _round in range(3):
        await pilot.pause()


def _asks(app: DeckApp) -> bool:
    """Whether a dialog is in front, or the picker with its lessons."""
    if isinstance(app.screen, PickerScreen):
        return any(rows.chosen for rows in app.screen.query(Rows))
    return isinstance(app.screen, Dialog)


LESSON_9 = OpenRequest(Path("profiles/09-brain.yaml"))


@asynccontextmanager
async def opened(
    opener: RecordedOpener | None = None,
    screen: str = "deck",
    size: tuple[int, int] = (120, 40),
    order: OpenRequest = LESSON_9,
) -> AsyncIterator[tuple[DeckApp, Pilot[Any]]]:
    """Run the app until the recorded session, or the picker, is on the screen."""
    app = DeckApp(opener or RecordedOpener(), order, screen)
    async with app.run_test(size=size) as pilot:
        await settle(pilot)
        yield app, pilot


def seen(app: App[Any]) -> str:
    return "\n".join(strip.text for strip in app.screen._compositor.render_strips())
