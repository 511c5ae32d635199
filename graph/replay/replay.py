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
from graph.calls.timeouts import ANSWER_WITHIN_S
from graph.data import CallResult, GraphUpdate, ParametersResult, SetResult
from graph.inner_states import LevelResult, TransitionResult
from graph.observer.interest import Interest
from graph.observer.requests import ObserverError
from graph.replay.player import NANOSECONDS, RATES, Player, ReplayState, next_rate
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping
    from pathlib import Path

    from graph.data import Value
    from graph.publishing.dead_man_switch import HeldCommand

logger = logging.getLogger(__name__)

STOP_WITHIN_S = 5.0

T = TypeVar("T")


class Replay:
    """A bag as a graph. All methods may be called from any thread; none waits for the bag."""

    def __init__(self, path: Path, *, rate: float = 1.0, loop: bool = False, start_s: float = 0.0) -> None:
        """Open the bag and play it from `start_s` once it is started. Raises BagError."""
        self.period_s = 0.1
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
        self._watched: frozenset[str] = frozenset()
        self._pictures: frozenset[str] = frozenset()
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

    def watch(self, topics: Iterable[str]) -> None:
        """Decode the newest message of exactly these topics each period."""
        self._watched = frozenset(topics)
        self._look_at(replace(self._interest, watched=self._watched | self._pictures))

    def watch_pictures(self, topics: Iterable[str]) -> None:
        """Watch these as well: there is no network to be spared."""
        self._pictures = frozenset(topics)
        self._look_at(replace(self._interest, watched=self._watched | self._pictures))

    def follow(self, topics: Iterable[str]) -> None:
        """Decode every message of exactly these topics."""
        self._look_at(replace(self._interest, followed=frozenset(topics)))

    def measure(self, all_topics: bool, *, images: bool = True, fast: bool = True) -> None:
        """Do nothing: every topic of a bag is measured."""

    def watch_goals(self, actions: Iterable[str]) -> None:
        """Do nothing: a bag has no actions."""

    def watch_inner_states(self, wanted: bool) -> None:
        """Do nothing: recordings contain no answers of nodes."""

    @property
    def inner(self) -> RecordedInner:
        """Requests to nodes, all of which are refused."""
        return RecordedInner()

    def watch_frames(self, wanted: bool) -> None:
        """Report in each update the frames that were published up to the playhead, or none."""
        self._look_at(replace(self._interest, frames=wanted))

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

    # Requests that a recording cannot serve: the caller gets a reason, never silence.

    def prepare_publisher(self, topic: str, type_name: str, *, latched: bool = False) -> Future[None]:
        del topic, type_name, latched
        return refused()

    def publish(
        self, topic: str, type_name: str, value: Mapping[str, Value], *, latched: bool = False
    ) -> Future[int]:
        del topic, type_name, value, latched
        return refused()

    def start_publishing(self, topic: str, type_name: str, value: Mapping[str, Value], hz: float) -> Future[int]:
        del topic, type_name, value, hz
        return refused()

    def stop_publishing(self, number: int) -> None:
        """Do nothing: nothing is published."""

    def stop_publishing_all(self) -> None:
        """Do nothing: nothing is published."""

    def stop_commanding(self) -> None:
        """Do nothing: nothing is commanded."""

    def prepare_hold(self, topic: str, type_name: str) -> Future[None]:
        del topic, type_name
        return refused()

    def hold(self, topic: str, type_name: str, command: HeldCommand) -> Future[int]:
        del topic, type_name, command
        return refused()

    def let_go(self, topic: str) -> None:
        """Do nothing: nothing is held."""

    def call(
        self, service: str, type_name: str, request: Mapping[str, Value], timeout_s: float = ANSWER_WITHIN_S
    ) -> Future[CallResult]:
        """Answer that there is no service."""
        del type_name, request, timeout_s
        return _done(CallResult(service, False, None, _refusal(), 0.0))

    def parameters(self, node: str, timeout_s: float = ANSWER_WITHIN_S) -> Future[ParametersResult]:
        """Answer that there are no parameters."""
        del timeout_s
        return _done(ParametersResult(node, error=_refusal()))

    def set_parameters(
        self, node: str, values: Mapping[str, Value], timeout_s: float = ANSWER_WITHIN_S
    ) -> Future[SetResult]:
        """Answer that no parameter can be set."""
        del values, timeout_s
        return _done(SetResult(node, error=_refusal()))

    def send_goal(self, action: str, type_name: str, goal: Mapping[str, Value]) -> Future[int]:
        del action, type_name, goal
        return refused()

    def cancel_goal(self, number: int) -> None:
        """Do nothing: there is no goal."""

    def cancel_seen_goal(self, action: str, goal_id: str) -> None:
        """Do nothing: there is no goal."""

    def forget_goal(self, number: int) -> None:
        """Do nothing: there is no goal."""

    def _order(self, order: Callable[[Player], None]) -> None:
        self._orders.append(order)
        self._wake.set()

    def _look_at(self, interest: Interest) -> None:
        with self._lock:
            self._interest = interest
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
            self._wake.wait(self.period_s)

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


class RecordedInner:
    """Answers that no node can be asked."""

    def change_state(
        self, node: str, transition: str, timeout_s: float = ANSWER_WITHIN_S
    ) -> Future[TransitionResult]:
        """Answer that no node changes."""
        del timeout_s
        return _done(TransitionResult(node, transition, error=_refusal()))

    def logger_level(self, node: str, timeout_s: float = ANSWER_WITHIN_S) -> Future[LevelResult]:
        """Answer that it is not known."""
        del timeout_s
        return _done(LevelResult(node, error=_refusal()))

    def set_logger_level(self, node: str, level: str, timeout_s: float = ANSWER_WITHIN_S) -> Future[LevelResult]:
        del level, timeout_s
        return _done(LevelResult(node, error=_refusal()))


def _refusal() -> str:
    return say("this is a recording: there is nobody to send to")


def refused() -> Future[T]:
    """Return the answer to a request that would change something in a recording."""
    future: Future[T] = Future()
    future.set_exception(ObserverError(_refusal()))
    return future


def _done(result: T) -> Future[T]:
    future: Future[T] = Future()
    future.set_result(result)
    return future
