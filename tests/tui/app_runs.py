"""The app at work with the recorded lesson 9, for tests that press its keys."""

from __future__ import annotations

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

from textual.pilot import Pilot

from tests.tui.recorded import RecordedOpener
from tests.tui.snapshots import settle
from tui.app import DeckApp
from tui.session.requests import OpenRequest

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
