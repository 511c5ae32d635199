"""One screen over a recorded graph, under a pilot."""

from __future__ import annotations

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from typing import Any, Generic, TypeVar

from textual.pilot import Pilot
from textual.screen import Screen

from graph.data import GraphUpdate
from tests.tui.recorded import RecordedOpener
from tests.tui.snapshots import Look, settle
from tui.app import DeckApp

HOME = Look((120, 40), "en")
S = TypeVar("S", bound=Screen[Any])
T = TypeVar("T", bound="ScreenStage[Any]")


class ScreenStage(Generic[S]):
    """What a test does and sees."""

    name: str
    """What the app calls the screen."""
    kind: type[S]

    def __init__(self, app: DeckApp, pilot: Pilot[Any], opener: RecordedOpener) -> None:
        self.app, self.pilot = app, pilot
        self.graph, self.session = opener.graph, opener.link

    @property
    def screen(self) -> S:
        found = self.app.get_screen(self.name)
        assert isinstance(found, self.kind)
        return found

    async def press(self, *keys: str) -> None:
        """Press these keys and wait until each is done."""
        for key in keys:
            await self.pilot.press(key)
            await self.pilot.pause()

    async def show(self, update: GraphUpdate) -> None:
        """Let the graph be this, and wait until it is drawn."""
        self.graph.show(update)
        for _round in range(3):
            await self.pilot.pause()


@asynccontextmanager
async def on_stage(stage: type[T], opener: RecordedOpener | None = None, look: Look = HOME) -> AsyncIterator[T]:
    opener = opener or RecordedOpener()
    app = look.app(stage.name, opener)
    async with app.run_test(size=look.size) as pilot:
        await settle(pilot)
        yield stage(app, pilot, opener)
