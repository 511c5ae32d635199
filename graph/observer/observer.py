"""The observer: one ROS node on a thread of its own, in the screen's process.

It looks at the graph and at its queues a few times a second and hands over plain data. Nothing
here is woken by a message, and no method of the observer waits for anything.
"""

from __future__ import annotations

import atexit
import logging
import threading
import time
from dataclasses import replace
from typing import TYPE_CHECKING

from graph.data import GraphUpdate
from graph.observer.asking import Asking
from graph.observer.interest import Interest
from graph.observer.orders import ObserverError
from graph.observer.station import LOOK_AT_GRAPH_S, Station
from graph.ros import open_ros
from graph.words import say

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

logger = logging.getLogger(__name__)

STOP_WITHIN_S = 5.0


class Observer(Asking):
    """The ROS graph of one domain as plain data. All methods may be called from any thread."""

    def __init__(
        self, domain: int, discovery: str | tuple[str, ...] = "localhost", period_s: float = 0.1
    ) -> None:
        """Prepare for a domain; `discovery` is localhost, subnet, or the addresses of peers."""
        super().__init__()
        self._domain = domain
        self._discovery = discovery
        self._period_s = period_s
        self._interest = Interest()
        self._stopping = False
        self._thread: threading.Thread | None = None

    @property
    def period_s(self) -> float:
        """Seconds between two updates."""
        return self._period_s

    @period_s.setter
    def period_s(self, period_s: float) -> None:
        self._period_s = period_s
        self._wake.set()

    def start(self, on_update: Callable[[GraphUpdate], None]) -> None:
        """Begin to observe; `on_update` is called on the observer's own thread.

        What was asked for before, and while rclpy is being imported, is done as soon as it is.
        """
        self._thread = threading.Thread(
            target=self._run, args=(on_update,), name="deck-observer", daemon=True
        )
        # DDS threads must be gone before the interpreter is.
        atexit.register(self.stop)
        self._thread.start()

    def stop(self) -> None:
        """Leave the graph; what is under way fails. Returns within a few seconds, whatever."""
        self._stopping = True
        self._wake.set()
        atexit.unregister(self.stop)
        if self._thread is None:
            self._refuse_orders(ObserverError(say("the observer was never started")))
        elif self._thread is not threading.current_thread():
            self._thread.join(STOP_WITHIN_S)

    def watch(self, topics: Iterable[str]) -> None:
        """Hand over the newest message of exactly these topics in each update."""
        self._look_at(watched=frozenset(topics))

    def follow(self, topics: Iterable[str]) -> None:
        """Hand over every message of exactly these topics, up to 200 of each in one update."""
        self._look_at(followed=frozenset(topics))

    def measure(self, all_topics: bool) -> None:
        """Measure the rates of all topics, or only of those watched and followed."""
        self._look_at(all_topics=all_topics)

    def watch_goals(self, actions: Iterable[str]) -> None:
        """Tell in each update of the goals that others have sent to exactly these actions."""
        self._look_at(actions=frozenset(actions))

    def _look_at(self, **changes: frozenset[str] | bool) -> None:
        with self._lock:
            wanted = replace(self._interest, **changes)  # type: ignore[arg-type]
            if wanted == self._interest:
                return
            self._interest = wanted
        self._wake.set()

    def _run(self, on_update: Callable[[GraphUpdate], None]) -> None:
        end = ObserverError(say("the observer has been stopped"))
        try:
            # This imports rclpy; the screen need not wait for it.
            station = Station(open_ros(self._domain, self._discovery))
            station.breathe = lambda: self._breathe(station)
        except Exception as error:  # noqa: BLE001 - told to the screen
            words = say("ROS cannot be used: {error}", error=str(error))
            end = ObserverError(words)
            self._tell(on_update, GraphUpdate(time.time(), error=words))
        else:
            try:
                self._observe(station, on_update)
            finally:
                station.close(end)
        finally:
            self._refuse_orders(end)

    def _observe(self, station: Station, on_update: Callable[[GraphUpdate], None]) -> None:
        next_look_s = 0.0
        interest = self._interest
        while not self._stopping:
            self._carry_out_orders(station)
            try:
                due_s = station.step()
                now_s = time.monotonic()
                if now_s >= next_look_s or self._interest is not interest:
                    interest = self._interest
                    period_s = LOOK_AT_GRAPH_S if station.is_idle else self._period_s
                    # In step, save that a look out of turn does not put off the next.
                    next_look_s = max(now_s, min(next_look_s, now_s) + period_s)
                    self._look(station, interest, on_update)
            except Exception as error:
                # The graph is in motion while it is looked at: the next look has another chance.
                logger.exception("a look at the graph failed")
                error_update = GraphUpdate(
                    time.time(), error=say("the ROS graph: {error}", error=str(error))
                )
                self._tell(on_update, error_update)
                next_look_s, due_s = time.monotonic() + LOOK_AT_GRAPH_S, None
            until_s = next_look_s if due_s is None else min(next_look_s, due_s)
            if self._wake.wait(max(0.0, until_s - time.monotonic())):
                self._wake.clear()

    def _look(
        self, station: Station, interest: Interest, on_update: Callable[[GraphUpdate], None]
    ) -> None:
        update = station.look(interest)
        if update is not None:
            self._tell(on_update, update)

    def _tell(self, on_update: Callable[[GraphUpdate], None], update: GraphUpdate) -> None:
        try:
            on_update(update)
        except Exception:
            # A screen that is being closed; the observer is stopped next.
            logger.exception("an update was not taken")
