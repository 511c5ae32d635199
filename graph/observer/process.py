"""The observer's process: it polls the graph and its queues, does what is asked for, and hands over plain data.

Messages do not wake it. All of ROS happens on the main thread, whose loop waits for nobody: one thread listens to the
screen and one speaks to it, however slowly that reads. It leaves if it is told to, if nobody is there any more, or if
ROS cannot be used. When it hangs, so that no Python runs, the kernel ends it after a while, whoever is there.
"""

from __future__ import annotations

import ctypes
import gc
import importlib
import logging
import os
import pickle
import signal
import sys
import threading
import time
import traceback
from collections import deque
from concurrent.futures import Future
from contextlib import suppress
from dataclasses import replace
from multiprocessing.connection import Connection
from typing import TYPE_CHECKING, Any

from graph.calls.goals import GoalError
from graph.data import CallResult, GraphUpdate, Interest
from graph.memory import GIVEN_BACK_EVERY_S, give_back_free_memory
from graph.messages.making import FieldError
from graph.messages.types import UnknownTypeError
from graph.observer.node import ObserverNode
from graph.observer.requests import Answer, ObserverError, Opening, Order, refuse
from graph.observer.updates import merged, news
from graph.publishing.outbox import PublishError
from graph.ros import open_ros
from text.sentences import reason_of, say

if TYPE_CHECKING:
    from collections.abc import Callable

logger = logging.getLogger(__name__)

OF_ROS = ("rclpy.node", "rclpy.event_handler", "rclpy.serialization", "sensor_msgs.msg")
"""Modules that are needed in nearly every domain, imported before anybody names one."""
SIGN_S = 1.0
"""Between two signs of life."""
STUCK_S = 60
"""The kernel ends a process that has not run for so long: it may hold Python's lock for ever."""
LEFT_WITHIN_S = 6
"""The same once it leaves."""
LAST_WORDS_S = 1.0
AGAIN_S = 0.25
"""Until the next look after one that has failed."""
GARBAGE_AFTER = 10_000
PR_SET_NAME, PR_SET_PDEATHSIG = 15, 1
"""Source: prctl(2)."""
TOLD = (ObserverError, PublishError, GoalError, FieldError, UnknownTypeError)
"""Errors that mean something to whoever asked; of others only their words do."""


class Speaker:
    """Says what there is to say on a thread of its own, so that nobody waits for the one who reads it.

    Of signs of life and updates at most one waits, of answers one for each request.
    """

    def __init__(self, end: Connection) -> None:
        self._end = end
        self._there = threading.Condition()
        self._words: deque[bytes] = deque()
        self._sign = self._is_over = False
        self._update: GraphUpdate | None = None
        self._last = GraphUpdate(0.0)
        self._thread = threading.Thread(target=self._run, name="speaker", daemon=True)
        self._thread.start()

    def say(self, words: object) -> None:
        raw = pickle.dumps(words)
        with self._there:
            self._words.append(raw)
            self._there.notify()

    def give_sign(self) -> None:
        with self._there:
            self._sign = True
            self._there.notify()

    def show(self, update: GraphUpdate) -> None:
        """Hand over an update, merged into the one that waits if there is one."""
        with self._there:
            self._update = update if self._update is None else merged(self._update, update)
            self._there.notify()

    def finish(self, within_s: float) -> None:
        """Return once all is said, so long at most."""
        with self._there:
            self._is_over = True
            self._there.notify()
        self._thread.join(within_s)

    def _run(self) -> None:
        with suppress(OSError):  # nobody is there any more: the listener finds that out
            while True:
                with self._there:
                    self._there.wait_for(lambda: self._words or self._sign or self._update or self._is_over)
                    words, self._words = self._words, deque()
                    update, self._update = self._update, None
                    self._sign, sign = False, self._sign
                    is_last = self._is_over
                if sign and update is None and not words:
                    words.append(pickle.dumps(None))
                for raw in words:
                    self._end.send_bytes(raw)
                if update is not None:
                    self._end.send_bytes(pickle.dumps(news(update, self._last)))
                    self._last = update
                if is_last:
                    return


class ObserverLoop:
    """One observer at work. All methods are called on the thread of `run`."""

    def __init__(self, end: Connection, alarm: Callable[[int], object] = int) -> None:
        """Serve this end; `alarm` has the kernel end this process in so many seconds."""
        self._end = end
        self._alarm = alarm
        self._heard: deque[Any] = deque()
        self._has_heard = threading.Event()
        self._speaker = Speaker(end)
        self._opening: Opening | None = None
        self._interest = Interest()
        self._urgent: deque[Order] = deque()
        self._orders: deque[Order] = deque()
        self._is_over = False
        self._began_s = time.monotonic()
        """From when on requests can be late."""
        self._next_sign_s = 0.0
        self._give_back_at_s = self._began_s + GIVEN_BACK_EVERY_S

    def run(self) -> None:
        """Observe until it is over."""
        self._alarm(STUCK_S)
        threading.Thread(target=self._listen, name="listener", daemon=True).start()
        # If ROS is missing, opening it reports that.
        with suppress(ImportError):
            for module in OF_ROS:
                importlib.import_module(module)
        while self._opening is None and not self._is_over:
            self._wait(SIGN_S)
        if self._opening is not None and not self._is_over:
            refusal = self._work(self._opening)
            if refusal is not None:
                self._speaker.say(refusal)
            self._speaker.finish(LAST_WORDS_S)

    def leave(self) -> None:
        if not self._is_over:
            self._is_over = True
            self._alarm(LEFT_WITHIN_S)

    def _work(self, opening: Opening) -> ObserverError | None:
        """Observe; return why that was impossible, if it was."""
        try:
            # This imports rclpy.
            ros = open_ros(opening.domain, opening.discovery, opening.role, opening.owner)
            node = ObserverNode(ros, opening.graph_s, opening.first_number)
        except Exception as error:  # noqa: BLE001 - reported to the screen
            return ObserverError(say("ROS cannot be used: {error}", error=str(error)))
        node.serve_urgent = lambda: self.serve_urgent(node)
        self._began_s = time.monotonic()
        try:
            self._observe(node)
        finally:
            node.close(ObserverError(say("the observer has been stopped")))
        return None

    def _observe(self, node: ObserverNode) -> None:
        next_look_s = 0.0
        interest = self._interest
        while not self._is_over:
            self.carry_out(node)
            try:
                due_s = node.step()
                now_s = time.monotonic()
                if now_s >= next_look_s or self._interest != interest:
                    interest = self._interest
                    period_s = node.graph_s if node.is_idle else interest.period_s
                    # At a steady pace; an extra look out of turn does not delay the next.
                    next_look_s = max(now_s, min(next_look_s, now_s) + period_s)
                    update = node.look(interest)
                    if update is not None:
                        self._speaker.show(update)
            except Exception as error:
                # The graph changes while it is being scanned: the next look has another chance.
                logger.exception("a look at the graph failed")
                self._speaker.show(GraphUpdate(time.time(), error=say("the ROS graph: {error}", error=str(error))))
                next_look_s, due_s = time.monotonic() + AGAIN_S, None
            until_s = next_look_s if due_s is None else min(next_look_s, due_s)
            self._wait(max(0.0, until_s - time.monotonic()))

    def serve_urgent(self, node: ObserverNode) -> None:
        """Serve what cannot wait for the end of a look, unless it needs a look itself: stops, and held topics."""
        self._give_sign()
        self._sort()
        while self._urgent and self._urgent[0].request.is_ready(node):
            self._begin(self._urgent.popleft(), node)
        node.dead_man_switch.step()

    def carry_out(self, node: ObserverNode) -> None:
        while self._urgent or self._orders:
            self._begin(self._urgent.popleft() if self._urgent else self._orders.popleft(), node)

    def take(self, words: object) -> None:
        """Take something that the screen has said, on any thread."""
        self._heard.append(words)
        self._has_heard.set()

    def _listen(self) -> None:
        try:
            while True:
                self.take(self._end.recv())
        except (EOFError, OSError):
            # As if it had been told to leave.
            self.take(None)

    def _wait(self, within_s: float) -> None:
        """Wait for something to be said, so long at most, and take that."""
        until_s = time.monotonic() + within_s
        while not self._is_over:
            self._give_sign()
            left_s = until_s - time.monotonic()
            if self._has_heard.wait(max(0.0, min(left_s, SIGN_S))):
                self._sort()
                return
            if left_s <= SIGN_S:
                return

    def _sort(self) -> None:
        """Take what has been said."""
        self._has_heard.clear()
        while self._heard:
            words = self._heard.popleft()
            if words is None:
                self.leave()
            elif isinstance(words, Interest):
                self._interest = words
            elif isinstance(words, Order):
                if words.request.hurries:
                    self._urgent.append(words)
                if not words.request.hurries or words.request.in_turn_too:
                    self._orders.append(words)
            else:
                self._opening = words

    def _begin(self, order: Order, node: ObserverNode) -> None:
        future: Future[Any] = Future()
        future.set_running_or_notify_cancel()
        future.add_done_callback(lambda done: self._answer(order.number, done))
        age_s = time.monotonic() - max(order.asked_s, self._began_s)
        try:
            if age_s > order.request.late_s:
                words = say("it was asked for {seconds} s ago, and is not done so late", seconds=f"{age_s:.0f}")
                raise ObserverError(words)  # noqa: TRY301 - a reason as any other
            order.request.begin(node, future)
        except Exception as error:  # noqa: BLE001 - reported to whoever asked
            refuse(order.request, future, error)

    def _answer(self, number: int, future: Future[Any]) -> None:
        error = future.exception()
        if error is not None:
            self._say(Answer(number, error=_told(error)))
            return
        result = future.result()
        late = result.late if isinstance(result, CallResult) else None
        if late is None:
            self._say(Answer(number, result))
            return
        # The other end puts a future of its own in its place.
        self._say(Answer(number, replace(result, late=None), is_first=True))
        late.add_done_callback(lambda done: self._say(Answer(number, done.result())))

    def _say(self, answer: Answer) -> None:
        try:
            self._speaker.say(answer)
        except Exception as error:  # noqa: BLE001 - what cannot be pickled, may it be whatever it is
            self._speaker.say(Answer(answer.number, error=ObserverError(str(error))))

    def _give_sign(self) -> None:
        now_s = time.monotonic()
        if now_s >= self._next_sign_s:
            self._next_sign_s = now_s + SIGN_S
            self._alarm(LEFT_WITHIN_S if self._is_over else STUCK_S)
            if self._opening is not None:
                self._speaker.give_sign()
        if now_s >= self._give_back_at_s:
            self._give_back_at_s = now_s + GIVEN_BACK_EVERY_S
            give_back_free_memory()


def _told(error: BaseException) -> Exception:
    return error if isinstance(error, TOLD) else ObserverError(reason_of(error))


def main(descriptor: int, parent: int) -> None:
    """Serve until it is over, and end this process: nothing of the middleware may hold up its end."""
    prctl = ctypes.CDLL(None).prctl
    # The end of the pipe says the same, unless somebody else has got hold of the other end.
    prctl(PR_SET_PDEATHSIG, signal.SIGTERM)
    prctl(PR_SET_NAME, b"deck: observer")
    if os.getppid() != parent:
        return
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    gc.set_threshold(GARBAGE_AFTER)
    loop = ObserverLoop(Connection(descriptor), signal.alarm)
    signal.signal(signal.SIGTERM, lambda *_: loop.leave())
    code = 1
    try:
        loop.run()
        code = 0
    except Exception:  # noqa: BLE001 - the last chance to say it
        traceback.print_exc()
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code)
