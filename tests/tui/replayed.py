"""The app on a small bag, standing still at a place, for tests of the replay."""

from __future__ import annotations

from collections.abc import AsyncIterator, Sequence
from contextlib import asynccontextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from textual.pilot import Pilot

from graph.replay.replay import Replay
from launcher.status import SessionInfo
from tests.tui.recorded import RecordedOpener
from tests.tui.snapshots import settle
from tui.app import DeckApp
from tui.lifecycle.opener import LiveOpener
from tui.session.ports import SessionLink
from tui.session.requests import Lesson, OpenRequest, ReplayRequest


@dataclass
class BagOpener(LiveOpener):
    """Opens a bag as the real one does, and makes it stand still from the beginning."""

    position_s: float = 0.0
    paused: bool = True
    opened: list[Replay] = field(default_factory=list)

    def __post_init__(self) -> None:
        super().__init__()

    async def open(self, order: OpenRequest) -> SessionLink:
        link = await super().open(order)
        replay = self.replay
        assert replay is not None
        self.opened.append(replay)
        if self.paused:
            replay.toggle()
        if self.position_s:
            replay.seek(self.position_s)
        return link

    async def lessons(self) -> list[Lesson]:
        return await RecordedOpener().lessons()

    async def scored(self, lessons: Sequence[Lesson]) -> list[Lesson]:
        return [*lessons]

    async def running(self) -> list[SessionInfo]:
        return []


@asynccontextmanager
async def replayed(
    bag: Path, screen: str = "deck", size: tuple[int, int] = (120, 40), **settings: Any
) -> AsyncIterator[tuple[DeckApp, Pilot[Any], Replay]]:
    """Run the app until the bag is on the screen."""
    opener = BagOpener(**settings)
    app = DeckApp(opener, OpenRequest(replay=ReplayRequest(bag)), screen)
    async with app.run_test(size=size) as pilot:
        await settle(pilot)
        yield app, pilot, opener.opened[0]
        await app.feed.disconnect()
