"""A bag played back as if it were a live graph, without ROS.

`Replay` implements the screen's port for a graph, but refuses whatever would change something. It
has its own thread, which reads, counts and decodes, and serves the screen's requests in order.
"""

from __future__ import annotations

import logging
import threading
import time
from collections import deque
from concurrent.futures import Future
from dataclasses import replace
from typing import TYPE_CHECKING, TypeVar

from graph.bag.errors import BagError
from graph.bag.reading import open_bag
from graph.data import GraphUpdate, Interest
from graph.observer.requests import ObserverError, Request, refuse
from graph.replay.player import NANOSECONDS, RATES, Player, ReplayState, next_rate
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

logger = logging.getLogger(__name__)

STOP_WITHIN_S = 5.0

T = TypeVar("T")


class Replay:
    """A bag as a graph. All methods may be called from any thread; none waits for the bag."""

    def __init__(self, path: Path, *, rate: float = 1.0, loop: bool = False, start_s: float = 0.0) -> None:
        """Open the bag and play it from `start_s` once it is started. Raises BagError."""
        self.bag = open_bag(path)
        """The open bag; only this replay's thread may read its messages."""
        self._state = ReplayState(
            length_s=self.bag.length_s,
            start_s=self.bag.start_ns * NANOSECONDS,
            rate=min(max(rate, RATES[0]), RATES[-1]),
            loop=loop,
            messages=self.bag.messages_count,
            is_cut=self.bag.is_cut,
            is_incomplete=self.bag.is_incomplete,
            notes=self.bag.notes,
        )
        self._start_s = start_s
        self._interest = Interest()
        self._shown = Interest()
        self._orders: deque[Callable[[Player], None]] = deque()
        self._lock = threading.Lock()
        self._wake = threading.Event()
        self._stopping = False
        self._thread: threading.Thread | None = None

    @property
    def state(self) -> ReplayState:
        return self._state

    def start(self, on_update: Callable[[GraphUpdate], None]) -> None:
        """Begin to play; `on_update` is called on the replay's own thread."""
        self._thread = threading.Thread(target=self._run, args=(on_update,), name="deck-replay", daemon=True)
        self._thread.start()

    def stop(self) -> None:
        self._stopping = True
        self._wake.set()
        if self._thread is None:
            self.bag.close()
        elif self._thread is not threading.current_thread():
            self._thread.join(STOP_WITHIN_S)

    def want(self, interest: Interest) -> None:
        """Have updates with exactly this: every topic is measured, and there is no network to spare pictures from."""
        with self._lock:
            self._interest = replace(interest, watched=interest.watched | interest.pictures)
        self._wake.set()

    def ask(self, request: Request[T]) -> Future[T]:
        """Refuse it, and say why: a recording has nobody who could do anything."""
        future: Future[T] = Future()
        refuse(request, future, ObserverError(say("this is a recording: there is nobody to send to")))
        return future

    def toggle(self) -> None:
        """Pause or continue; at the end, start again."""

        def do(player: Player) -> None:
            if player.ended:
                player.seek(0.0)
                self._set(paused=False)
            else:
                self._set(paused=not self._state.paused)

        self._order(do)

    def step(self) -> None:
        """Pause, and take the next message, of the watched topics if there are any."""

        def do(player: Player) -> None:
            self._set(paused=True)
            player.step(self._interest.watched)

        self._order(do)

    def seek(self, position_s: float) -> None:
        """Jump to this many seconds after the first message."""
        self._order(lambda player: self._jump(player, position_s))

    def skip(self, seconds: float) -> None:
        """Jump forward by this many seconds, back if negative."""
        self._order(lambda player: self._jump(player, player.position_s + seconds))

    def change_rate(self, *, faster: bool) -> None:
        """Switch to the next rate above or below."""
        self._order(lambda _: self._set(rate=next_rate(self._state.rate, faster=faster)))

    def set_loop(self, loop: bool) -> None:
        """Start again at the end, or stay there."""
        self._order(lambda _player: self._set(loop=loop))

    def _order(self, order: Callable[[Player], None]) -> None:
        self._orders.append(order)
        self._wake.set()

    def _set(self, **changes: float | bool | str) -> None:
        self._state = replace(self._state, **changes)  # type: ignore[arg-type]

    def _jump(self, player: Player, position_s: float) -> None:
        player.seek(position_s)
        # The screen sees the target of the jump even while paused.
        self._shown = Interest()

    def _run(self, on_update: Callable[[GraphUpdate], None]) -> None:
        bag = self.bag
        try:
            player = Player(bag, lambda: self._stopping)
            if self._start_s:
                player.seek(self._start_s)
            self._play(player, on_update)
        except BagError as error:
            self._fail(error.words, on_update)
        except Exception as error:
            logger.exception("the replay failed")
            self._fail(say("the recording cannot be played: {reason}", reason=error), on_update)
        finally:
            bag.close()

    def _play(self, player: Player, on_update: Callable[[GraphUpdate], None]) -> None:
        before_s = time.monotonic()
        told: tuple[object, ...] = ()
        while not self._stopping:
            self._wake.clear()
            ordered = self._carry_out(player)
            now_s = time.monotonic()
            if not self._state.paused:
                self._advance(player, now_s - before_s)
            before_s = now_s
            self._set(position_s=player.position_s, ended=player.ended, damage=self.bag.damage or "")
            update = self._update(player)
            news = (update.topics, update.frames)
            if update.samples or ordered or news != told:
                told = news
                on_update(update)
            self._wake.wait(self._interest.period_s)

    def _advance(self, player: Player, seconds: float) -> None:
        if player.ended and self._state.loop:
            # Not earlier: by now the last messages have been handed over.
            self._jump(player, 0.0)
            return
        player.advance(seconds * self._state.rate)
        if player.ended and not self._state.loop:
            self._set(paused=True)

    def _carry_out(self, player: Player) -> bool:
        """Serve pending requests; return whether there were any."""
        found = bool(self._orders)
        while self._orders:
            self._orders.popleft()(player)
        return found

    def _update(self, player: Player) -> GraphUpdate:
        interest, shown = self._interest, self._shown
        self._shown = interest
        wall_s = time.time()
        fresh = interest.named - shown.named
        samples = player.topics.samples(interest, fresh, wall_s, player.now_ns)
        now_s = player.now_ns * NANOSECONDS
        rows = player.topics.rows(interest, now_s, self._state.start_s)
        frames = player.topics.frames(now_s) if interest.frames else ()
        return GraphUpdate(wall_s, rows, samples, nodes=(player.topics.node,), frames=frames)

    def _fail(self, words: str, on_update: Callable[[GraphUpdate], None]) -> None:
        self._set(error=words, paused=True)
        on_update(GraphUpdate(time.time(), error=words))
