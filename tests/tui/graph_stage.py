"""The screen of the graph over a recorded one, under a pilot."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractAsyncContextManager

from tests.tui.recorded import RecordedGraph, RecordedOpener
from tests.tui.recorded_nodes import graph_update
from tests.tui.screen_stage import HOME, ScreenStage, on_stage
from tests.tui.snapshots import Look, seen
from tests.waiting import until
from tui.graph.screen import GraphScreen


class GraphStage(ScreenStage[GraphScreen]):
    """The screen of the graph."""

    name, kind = "graph", GraphScreen

    async def choose(self, name: str) -> None:
        self.screen.names.choose(f"{self.screen.history.kind.value}|{name}")
        await self.pilot.pause()
        await self.pilot.pause()
        assert self.screen.names.chosen_name == name

    def seen(self) -> str:
        return seen(self.app)

    async def wait(self, told: Callable[[], object]) -> None:
        await until(told, lambda: f"what was awaited; on the terminal:\n{self.seen()}")

    async def wait_for(self, words: str) -> None:
        """Wait until these words are on the terminal, with as many blanks as may be."""
        await self.wait(lambda: words in " ".join(self.seen().split()))


def opened(graph: RecordedGraph | None = None, look: Look = HOME) -> AbstractAsyncContextManager[GraphStage]:
    """Open the screen of the graph of lesson 9."""
    graph = graph or RecordedGraph(update=graph_update())
    return on_stage(GraphStage, RecordedOpener(graph=graph), look)
