"""The emergency stop in action: shown at once, published, and backed up if nobody listens."""

from __future__ import annotations

import asyncio
import math
import time
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

from graph.observer.requests import PreparePublisher, Publish, StopPublishingAll
from safety.stop_file import StopFile
from safety.topics import EMERGENCY_STOP
from text.i18n import _
from text.plain import plain
from tui import clock
from tui.emergency import state as emergency
from tui.emergency.state import Emergency, listeners
from tui.emergency.words import shown_of

if TYPE_CHECKING:
    from collections.abc import Callable
    from concurrent.futures import Future

    from textual.app import App

    from graph.data import GraphUpdate
    from tui.session.feed import Feed

SENT_WITHIN_S = 2.0
KEPT_WITHIN_S, CONFIRMED_WITHIN_S, LOOK_S = 1.0, 15.0, 0.1
"""Within what a stop is on disk, and another observer has taken the place of one that hangs."""
OPENED_WITHIN_S, SEEN_WITHIN_S = 20.0, 2.0
"""How long a stop waits for nodes that are starting, and for the graph to show one that has."""
AGAIN_S = 1.0
"""Interval at which a release is repeated for nodes that still hold, with the time of the first."""
INSIST_S = 10.0
"""For how long it is repeated: a node that takes longer needs a person to look at it."""
PASSED_ON_AFTER_S, FRESH_S = 0.3, 2.0
"""Nodes that have heard a stop of another say so within this, on a machine that is not busy. What
was said longer ago is a latched message, which nodes hear whenever they come."""
ENDED = frozenset({"exited", "failed"})
WHY_S = 20.0
"""How long a notification says what else the stop has ended, and why."""


class Pressed(NamedTuple):
    """A stop that was published from here."""

    at_s: float
    """Unix time."""
    sent: Future[int] | None
    """Says whether ROS accepted it; None without a graph."""


class EmergencyControl:
    """Engages and releases the stop; the banner shows its `state`."""

    def __init__(self, app: App[Any], feed: Feed, changed: Callable[[], None]) -> None:
        """Act on the session of `feed`, notify in `app`, and call `changed` on every change."""
        self._app = app
        self._feed = feed
        self._changed = changed
        self.state = Emergency()
        self._released_ns, self._said_s = 0, 0.0
        """When a release was said here, and when it last went out, Unix time."""
        self._passed_on_s = 0.0
        """When the last stop was heard that was passed on from here, Unix time."""

    def engage(self) -> None:
        """Stop the wheels: publish the stop, or stop the nodes if nobody listens."""
        # Published before anything is drawn or queued.
        self.pressed(self.publish_now())

    def publish_now(self) -> Pressed:
        """Publish the stop, on any thread; `pressed` has to follow, on the app's."""
        sent = self._publish(engaged=True)
        graph = self._feed.graph
        if graph is not None:
            graph.ask(StopPublishingAll())
        return Pressed(clock.now(), sent)

    def pressed(self, press: Pressed) -> None:
        """Show a stop that has been published, and stop the nodes if nobody listens."""
        self._tell_of_publications()
        is_open = self._feed.link is not None
        self._set(self.state.pressed(press.at_s, waits=not is_open))
        if is_open:
            self._app.run_worker(self._stop(press.sent), group="emergency")

    def release(self) -> None:
        """Let the wheels turn again, but let nothing start them automatically."""
        ended = self.state.ended
        self._end_publications()
        self._released_ns, self._said_s = time.time_ns(), clock.now()
        self._set(self.state.released(self._said_s))
        self._app.run_worker(self._release(self._publish(engaged=False)), group="emergency")
        if ended:
            self._app.run_worker(self._start_again(ended), group="emergency")

    def see(self, update: GraphUpdate) -> None:
        """Take in what others have done, and repeat what a node has not heard."""
        before, state = self.state, self.state.seen(update)
        if state.engaged != before.engaged:
            self._end_publications()
        self._set(state)
        if before.engaged and not state.engaged and not state.ours and self._feed.replay is None:
            words = _("The emergency stop was released elsewhere: the wheels may turn.")
            self._app.notify(words, severity="warning", timeout=WHY_S, markup=False)
        self._repeat_release(state)
        if state.unconfirmed and not state.ours and self._feed.replay is None:
            self._pass_on(state)

    def _repeat_release(self, state: Emergency) -> None:
        """Say it again, by the road: a new message would release stops that have come since."""
        link, now_s = self._feed.link, clock.now()
        in_vain = any(state.nodes[name].held_s > self._said_s + AGAIN_S for name in state.awaited)
        if link is not None and in_vain and now_s - state.since_s < INSIST_S:
            self._said_s = now_s
            link.emergency_stop(False, self._released_ns)

    def _pass_on(self, state: Emergency) -> None:
        """Give a stop by another that only this screen may have heard."""
        is_fresh = state.asked_s - state.said_s < FRESH_S
        is_due = clock.now() - state.asked_s > PASSED_ON_AFTER_S
        if is_fresh and is_due and state.asked_s != self._passed_on_s:
            self._passed_on_s = state.asked_s
            self._app.run_worker(self._reached(self._publish(engaged=True)), group="emergency")

    def begin(self) -> None:
        """Begin with the session that is open now: it gets the stop that was pressed meanwhile."""
        waits = self.state.waits and self._feed.replay is None
        self.forget()
        if waits:
            self.engage()

    def forget(self) -> None:
        """Forget the session, and the stop that nobody can obey any more."""
        self._set(Emergency())

    def prepare(self) -> None:
        """Create the publisher, so that the first message goes out at once."""
        graph = self._feed.graph
        if graph is not None:
            prepared = graph.ask(PreparePublisher(EMERGENCY_STOP, emergency.TOPIC_TYPE, latched=True))
            # If it cannot be created, publishing reports that.
            prepared.add_done_callback(lambda future: future.cancelled() or future.exception())

    async def _stop(self, sent: Future[int] | None) -> None:
        """Stop all nodes as well if the message cannot have reached anybody."""
        feed = self._feed
        if await self._waits_for_listener():
            if not self.state.waits:
                return
            self._set(replace(self.state, waits=False))
            sent = self._publish(engaged=True)
        reached = listeners(feed.update) > 0
        sending = asyncio.ensure_future(self._reached(sent))
        if reached and (await sending or await self._is_obeyed()):
            return
        unheard = emergency.NO_GRAPH if reached else _unheard(feed.update)
        reason = emergency.NOT_OURS if feed.watching else unheard
        ending = [name for name, node in feed.nodes.items() if node.state.value not in ENDED]
        self._set(self.state.fallen_back(reason, tuple(ending)))
        # The title has room for it only on wide terminals, and drops it after the release.
        self._app.notify(_(reason), severity="error", timeout=WHY_S, markup=False)
        if feed.link is not None:
            await feed.link.stop()
        await sending

    async def _waits_for_listener(self) -> bool:
        """Wait as long as a node that listens may still come; return whether that took a while.

        It has then ended early if the stop does not wait any more: it was released, or pressed
        again, or the session has ended.
        """
        feed, began_s = self._feed, time.monotonic()
        link, since_s, coming_s = feed.link, self.state.since_s, -math.inf
        waited = False
        while not listeners(feed.update):
            now_s = time.monotonic()
            if self._may_come():
                coming_s = now_s
            if now_s - coming_s > SEEN_WITHIN_S or now_s - began_s > OPENED_WITHIN_S:
                break
            if not waited:
                waited = True
                self._set(replace(self.state, waits=True))
            await asyncio.sleep(LOOK_S)
            if not self.state.waits or self.state.since_s != since_s:
                break
            if feed.link is not link:
                self._set(replace(self.state, waits=False))
                break
        return waited

    def _may_come(self) -> bool:
        """Whether there may soon be a listener: ROS is about to be seen, or nodes are starting."""
        update, nodes = self._feed.update, self._feed.nodes.values()
        if update is None:
            return True
        return not update.error and any(
            node.state.coming or (node.state.alive and (node.uptime_s or 0.0) < SEEN_WITHIN_S) for node in nodes
        )

    async def _is_obeyed(self) -> bool:
        """Whether nodes that obey stops have this one by the disk, though ROS does not answer here.

        What hangs may be this screen's observer alone. Until another has taken its place, nobody
        hears them confirm it: that is no reason to end them.
        """
        session = None if self._feed.link is None else self._feed.link.session
        if session is None or not self.state.nodes:
            return False
        file, began_s = StopFile(session.domain, "/screen"), time.monotonic()
        while (passed_s := time.monotonic() - began_s) < CONFIRMED_WITHIN_S:
            if not self.state.unconfirmed:
                return True
            kept = await asyncio.to_thread(file.read)
            if not kept.record.engaged and passed_s > KEPT_WITHIN_S:
                return False
            await asyncio.sleep(LOOK_S)
        return False

    async def _release(self, sent: Future[int] | None) -> None:
        """Release it by the road as well, behind the message, which says whose stops it ends."""
        said_ns, link = self._released_ns, self._feed.link
        await self._reached(sent)
        if link is not None:
            link.emergency_stop(False, said_ns)

    async def _start_again(self, ended: tuple[str, ...]) -> None:
        """Restart the nodes that were stopped instead of the wheels."""
        feed = self._feed
        names = [name for name in ended if name in feed.nodes]
        if feed.link is None or not names:
            return
        words = _("Restarted what the stop had ended: {nodes}")
        told = words.format(nodes=", ".join(map(plain, names)))
        self._app.notify(told, timeout=WHY_S, markup=False)
        await feed.link.start(*names)

    def _publish(self, *, engaged: bool) -> Future[int] | None:
        """Publish the latched message; None without a graph.

        Beside a stop goes the road that needs no ROS, in case that hangs. Where no node listens, it
        would keep a stop that nobody can obey.
        """
        graph, update, link = self._feed.graph, self._feed.update, self._feed.link
        heard = update is None or update.error or listeners(update)
        if engaged and link is not None and heard:
            link.emergency_stop(True, time.time_ns())
        if graph is None:
            return None
        message = {"data": engaged}
        return graph.ask(Publish(EMERGENCY_STOP, emergency.TOPIC_TYPE, message, latched=True))

    def _end_publications(self) -> None:
        """Stop all periodic publishing: it would drive the robot as soon as the stop is released.

        This includes what was started during the stop, whoever releases it.
        """
        if self._feed.graph is not None:
            self._feed.graph.ask(StopPublishingAll())
            self._tell_of_publications()

    def _tell_of_publications(self) -> None:
        feed = self._feed
        publications = () if feed.update is None else feed.update.publications
        topics = dict.fromkeys(one.topic for one in publications if not one.error)
        if topics:
            words = _("Deck has stopped publishing to {topics}: the emergency stop ended it.")
            told = words.format(topics=", ".join(topics))
            self._app.notify(told, severity="warning", timeout=WHY_S, markup=False)

    async def _reached(self, sent: Future[int] | None) -> bool:
        if sent is None:
            return False
        try:
            await asyncio.wait_for(asyncio.wrap_future(sent), SENT_WITHIN_S)
        except Exception:  # noqa: BLE001 - after any failure the nodes are stopped instead
            return False
        return True

    def _set(self, state: Emergency) -> None:
        shown = shown_of(self.state) != shown_of(state)
        self.state = state
        if shown:
            self._changed()


def _unheard(update: GraphUpdate | None) -> str:
    """Return why nobody can have received it."""
    return emergency.NO_GRAPH if update is None or update.error else emergency.NO_LISTENER
