"""The emergency stop at work: shown at once, sent, and what is done if nobody listens."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from tui import clock, emergency
from tui.emergency import Emergency, listeners

if TYPE_CHECKING:
    from graph.data import GraphUpdate
    from tui.app import DeckApp
    from tui.seams import GraphLink

SENT_WITHIN_S = 1.0


class Brake:
    """Engages and releases; its `state` is what the banner shows."""

    def __init__(self, app: DeckApp) -> None:
        """Act on the session of `app`."""
        self._app = app
        self.state = Emergency()

    def engage(self) -> None:
        """Stop the wheels: said on the topic, or by stopping the nodes if nobody hears."""
        self._set(self.state.pressed(clock.now()))
        self._app.run_worker(self._stop(), group="brake")

    def release(self) -> None:
        """Let the wheels turn again."""
        self._set(self.state.released(clock.now()))
        self._app.run_worker(self._send(engaged=False), group="brake")

    def see(self, update: GraphUpdate) -> None:
        """Take in what others have done."""
        self._set(self.state.seen(update))

    def forget(self) -> None:
        """Start anew with another session."""
        self._set(Emergency())

    async def _stop(self) -> None:
        """Publish; where that cannot have reached anybody, stop all nodes as well."""
        feed = self._app.feed
        reached = listeners(feed.update)
        sent = await self._send(engaged=True)
        if sent and reached:
            return
        self._set(self.state.fallen_back(emergency.NO_LISTENER if sent else emergency.NO_GRAPH))
        if feed.link is not None:
            await feed.link.stop()

    async def _send(self, *, engaged: bool) -> bool:
        """Publish the latched word; return whether ROS took it."""
        graph = self._app.feed.graph
        if graph is None:
            return False
        return await _published(graph, engaged)

    def _set(self, state: Emergency) -> None:
        if state != self.state:
            self.state = state
            self._app.emergency_changed()


async def _published(graph: GraphLink, engaged: bool) -> bool:
    future = graph.publish(emergency.TOPIC, emergency.TOPIC_TYPE, {"data": engaged}, latched=True)
    try:
        await asyncio.wait_for(asyncio.wrap_future(future), SENT_WITHIN_S)
    except Exception:  # noqa: BLE001 - whatever it was, the nodes are stopped in its place
        return False
    return True
