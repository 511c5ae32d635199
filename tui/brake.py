"""The emergency stop at work: shown at once, sent, and what is done if nobody listens."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from tui import clock, emergency
from tui.emergency import Emergency, listeners
from tui.i18n import _

if TYPE_CHECKING:
    from concurrent.futures import Future

    from graph.data import GraphUpdate
    from tui.app import DeckApp

SENT_WITHIN_S = 2.0
WHY_S = 20.0
"""How long it is told what else the stop has ended, and why."""


class Brake:
    """Engages and releases; its `state` is what the banner shows."""

    def __init__(self, app: DeckApp) -> None:
        """Act on the session of `app`."""
        self._app = app
        self.state = Emergency()

    def engage(self) -> None:
        """Stop the wheels: said on the topic, or by stopping the nodes if nobody hears."""
        # On its way before anything is drawn, or waits for its turn.
        sent = self._publish(engaged=True)
        self._end_publications()
        self._set(self.state.pressed(clock.now()))
        self._app.run_worker(self._stop(sent), group="brake")

    def release(self) -> None:
        """Let the wheels turn again, and nothing turn them by itself."""
        self._end_publications()
        self._set(self.state.released(clock.now()))
        self._app.run_worker(self._reached(self._publish(engaged=False)), group="brake")

    def see(self, update: GraphUpdate) -> None:
        """Take in what others have done."""
        state = self.state.seen(update)
        if state.engaged != self.state.engaged:
            self._end_publications()
        self._set(state)

    def forget(self) -> None:
        """Start anew with another session."""
        self._set(Emergency())

    def prepare(self) -> None:
        """Have the publisher made, so that the first word goes out at once."""
        graph = self._app.feed.graph
        if graph is not None:
            prepared = graph.prepare_publisher(emergency.TOPIC, emergency.TOPIC_TYPE, latched=True)
            # If it cannot be made, publishing will say so.
            prepared.add_done_callback(lambda future: future.cancelled() or future.exception())

    async def _stop(self, sent: Future[int] | None) -> None:
        """Where the stop cannot have reached anybody, stop all nodes as well."""
        feed = self._app.feed
        reached = listeners(feed.update) > 0
        sending = asyncio.ensure_future(self._reached(sent))
        if reached and await sending:
            return
        unheard = emergency.NO_GRAPH if reached else _unheard(feed.update)
        reason = emergency.NOT_OURS if feed.watching else unheard
        self._set(self.state.fallen_back(reason))
        # The title has room for it on wide terminals only, and forgets it with the release.
        self._app.notify(_(reason), severity="error", timeout=WHY_S, markup=False)
        if feed.link is not None:
            await feed.link.stop()
        await sending

    def _publish(self, *, engaged: bool) -> Future[int] | None:
        """Publish the latched word; None without a graph."""
        graph = self._app.feed.graph
        if graph is None:
            return None
        message = {"data": engaged}
        return graph.publish(emergency.TOPIC, emergency.TOPIC_TYPE, message, latched=True)

    def _end_publications(self) -> None:
        """Publish nothing at a rate any more: it would drive as soon as the stop is released.

        That is why what was begun during the stop ends, too, whoever releases it.
        """
        feed = self._app.feed
        if feed.graph is None:
            return
        feed.graph.stop_publishing_all()
        publications = () if feed.update is None else feed.update.publications
        topics = dict.fromkeys(one.topic for one in publications if not one.error)
        if topics:
            words = _("Deck publishes no more to {topics}: the emergency stop has ended it.")
            told = words.format(topics=", ".join(topics))
            self._app.notify(told, severity="warning", timeout=WHY_S, markup=False)

    async def _reached(self, sent: Future[int] | None) -> bool:
        """Return whether ROS took it."""
        if sent is None:
            return False
        try:
            await asyncio.wait_for(asyncio.wrap_future(sent), SENT_WITHIN_S)
        except Exception:  # noqa: BLE001 - whatever it was, the nodes are stopped in its place
            return False
        return True

    def _set(self, state: Emergency) -> None:
        if state != self.state:
            self.state = state
            self._app.emergency_changed()


def _unheard(update: GraphUpdate | None) -> str:
    """Return why nobody can have heard it."""
    return emergency.NO_GRAPH if update is None or update.error else emergency.NO_LISTENER
