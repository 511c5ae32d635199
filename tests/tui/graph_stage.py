"""The screen of the graph over a recorded one, under a pilot."""

from __future__ import annotations

from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from typing import TYPE_CHECKING, Any

from tests.tui.recorded import RecordedGraph, RecordedOpener
from tests.tui.recorded_nodes import graph_update
from tests.tui.snapshots import Look, settle
from tests.waiting import until
from tui.graph.screen import GraphScreen

if TYPE_CHECKING:
    from textual.pilot import Pilot

    from graph.data import GraphUpdate
    from tui.app import DeckApp

HOME = Look((120, 40), "en")


class Stage:
    """What a test does and sees."""

    def __init__(self, app: DeckApp, pilot: Pilot[Any], graph: RecordedGraph) -> None:
        self.app, self.pilot, self.graph = app, pilot, graph

    @property
    def screen(self) -> GraphScreen:
        """The screen of the graph, in front or not."""
        screen = self.app.get_screen("graph")
        assert isinstance(screen, GraphScreen)
        return screen

    async def press(self, *keys: str) -> None:
        """Press these keys and wait until they are done."""
        for key in keys:
            await self.pilot.press(key)
            await self.pilot.pause()

    async def choose(self, name: str) -> None:
        """Choose a name in the list."""
        self.screen.names.choose(f"{self.screen.history.kind.value}|{name}")
        await self.pilot.pause()
        await self.pilot.pause()
        assert self.screen.names.chosen_name == name

    async def show(self, update: GraphUpdate) -> None:
        """Let the graph be this, and wait until it is drawn."""
        self.graph.show(update)
        await self.pilot.pause()
        await self.pilot.pause()

    def seen(self) -> str:
        """All that is on the terminal."""
        strips = self.app.screen._compositor.render_strips()
        return "\n".join(strip.text for strip in strips)

    async def wait(self, told: Callable[[], object]) -> None:
        """Wait until this is so."""
        await until(told, lambda: f"what was awaited; on the terminal:\n{self.seen()}")

    async def wait_for(self, words: str) -> None:
        """Wait until these words are on the terminal, with as many blanks as may be."""
        await self.wait(lambda: words in " ".join(self.seen().split()))


@asynccontextmanager
async def opened(graph: RecordedGraph | None = None, look: Look = HOME) -> AsyncIterator[Stage]:
    """Open the screen of the graph of lesson 9."""
    graph = graph or RecordedGraph(update=graph_update())
    app = look.app("graph", RecordedOpener(graph=graph))
    async with app.run_test(size=look.size) as pilot:
        await settle(pilot)
        yield Stage(app, pilot, graph)
