"""What the observer's process does: it serves the end of the socket that it was given.

It takes orders and hands over updates, answers, and a sign of life each second. Its own end has
three causes: it gets that order, nobody is there any more, or ROS cannot be used. When it hangs,
so that no Python runs, the kernel ends it after a while, whoever is there.
"""

from __future__ import annotations

import gc
import importlib
import os
import select
import signal
import sys
import time
import traceback
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from graph.memory import GIVEN_BACK_EVERY_S, give_back_free_memory
from graph.observer.loop import ObserverLoop
from graph.observer.merging import merged
from graph.observer.process import language
from graph.observer.process.plain import PlainError, packed, plain_error, unpacked
from graph.observer.process.updates import Shortener
from graph.observer.requests import ObserverError
from graph.observer.settings import ObserverSettings
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Callable
    from concurrent.futures import Future

    from graph.data import CallResult, GraphUpdate
    from graph.observer.process.language import Order
    from graph.observer.process.wire import Wire

OF_ROS = ("rclpy.node", "rclpy.event_handler", "rclpy.serialization", "sensor_msgs.msg")
"""Modules that are needed in nearly every domain, imported before anybody names one."""
SIGN_S = 1.0
"""Between two signs of life."""
CENSUS_S = 1.0
"""Between two counts of who is there."""
STUCK_S = 60
"""The kernel ends a process that has not run for so long: it may hold Python's lock for ever."""
LEFT_WITHIN_S = 6
"""The same once it leaves."""
LAST_WORDS_S = 1.0
GARBAGE_AFTER = 10_000


class Server:
    """Serves one screen, until it leaves."""

    def __init__(self, wire: Wire, alarm: Callable[[int], object] = int) -> None:
        """Take over this end; `alarm` has the kernel end this process in so many seconds."""
        self._wire = wire
        self._alarm = alarm
        self._loop: ObserverLoop | None = None
        self._shortener = Shortener()
        self._waiting: GraphUpdate | None = None
        """An update that has no room yet."""
        self._futures: dict[int, Future[Any]] = {}
        self._since_s = time.monotonic()
        """From when on orders can be late."""
        self._next_sign_s = 0.0
        self._next_census_s = 0.0
        self._give_back_at_s = self._since_s + GIVEN_BACK_EVERY_S
        self._over = False

    def run(self) -> None:
        """Serve; return when it is over."""
        self._alarm(STUCK_S)
        self._await_loop()
        self._since_s = time.monotonic()
        if self._loop is not None and not self._over:
            refusal = self._loop.run()
            self._alarm(LEFT_WITHIN_S)
            self._say_at_last(language.OVER, refusal)

    def tell(self, update: GraphUpdate) -> None:
        """Hand over an update, or merge it into the one that waits."""
        self._waiting = update if self._waiting is None else merged(self._waiting, update)
        self._go_on()

    def wait(self, within_s: float) -> None:
        """Wait for orders, so long at most, and take them."""
        until_s = time.monotonic() + within_s
        while True:
            now_s = time.monotonic()
            self._give_sign(now_s)
            self._tell_who_is_there(now_s)
            self._give_memory_back(now_s)
            left_s = min(until_s, self._next_sign_s) - now_s
            wanted = select.POLLIN | (select.POLLOUT if self._wire.is_behind else 0)
            waiting = select.poll()
            waiting.register(self._wire.fileno(), wanted)
            came = waiting.poll(max(0.0, left_s) * 1000.0)
            if came:
                self._go_on()
                if self.look() or self._over:
                    return
            if time.monotonic() >= until_s:
                return

    def look(self) -> bool:
        """Take the orders that have come; return whether there were any."""
        self._give_sign(time.monotonic())
        try:
            packets = self._wire.receive()
        except (EOFError, OSError):
            packets = []
            self.leave()
        for order in map(unpacked, packets):
            self._obey(order)
        return bool(packets)

    def _await_loop(self) -> None:
        """Import what will be needed, and wait for the domain to watch."""
        imported = False
        while self._loop is None and not self._over:
            self.wait(SIGN_S)
            if not imported and sys.path:
                imported = True
                # If ROS is missing, the loop reports that.
                with suppress(ImportError):
                    for module in OF_ROS:
                        importlib.import_module(module)

    def _obey(self, order: Order) -> None:
        number, name, arguments, asked_s = order
        if name == language.PATH:
            sys.path[:] = arguments
        elif name == language.OPEN:
            self._loop = ObserverLoop(ObserverSettings(*arguments[0]), self)
        elif name == language.DROP:
            self._drop(*arguments)
        elif name == language.LEAVE or self._loop is None:
            self.leave()
        elif name == language.NUMBER:
            self._loop.number_from(*arguments)
        elif name in language.WANTED:
            self._want(name, arguments[0])
        elif self._is_too_late(name, arguments, asked_s):
            age = f"{self._age(asked_s):.0f}"
            words = say("it was asked for {seconds} s ago, and is not done so late", seconds=age)
            self._say(language.FAILED, number, ObserverError(words))
        elif name in (*language.ENDING, *language.PREPARING, *language.DOING):
            future = getattr(self._loop.orders, name)(*arguments)
            if number and future is not None:
                self._futures[number] = future
                future.add_done_callback(lambda done: self._answer(number, done))

    def _want(self, name: str, value: Any) -> None:  # noqa: ANN401
        assert self._loop is not None
        if name == "set_period":
            self._loop.period_s = value
        else:
            getattr(self._loop, name)(value)

    def _age(self, asked_s: float) -> float:
        return time.monotonic() - max(asked_s, self._since_s)

    def _is_too_late(self, name: str, arguments: tuple[Any, ...], asked_s: float) -> bool:
        return self._age(asked_s) > language.late_s(name, arguments)

    def _drop(self, number: int) -> None:
        future = self._futures.get(number)
        if future is not None:
            future.cancel()

    def _answer(self, number: int, future: Future[Any]) -> None:
        self._futures.pop(number, None)
        if future.cancelled():
            return
        error = future.exception()
        if error is not None:
            self._say(language.FAILED, number, plain_error(error))
            return
        result = future.result()
        late: Future[CallResult] | None = getattr(result, "late", None)
        if late is None:
            self._say(language.DONE, number, result, False)
            return
        self._say(language.DONE, number, _without_late(result), True)
        late.add_done_callback(lambda done: self._answer_later(number, done))

    def _answer_later(self, number: int, future: Future[CallResult]) -> None:
        if not future.cancelled() and future.exception() is None:
            self._say(language.LATER, number, future.result())

    def _give_sign(self, now_s: float) -> None:
        if now_s >= self._next_sign_s:
            self._next_sign_s = now_s + SIGN_S
            self._alarm(STUCK_S)
            self._say(language.ALIVE)

    def _give_memory_back(self, now_s: float) -> None:
        if now_s >= self._give_back_at_s:
            self._give_back_at_s = now_s + GIVEN_BACK_EVERY_S
            give_back_free_memory()

    def _tell_who_is_there(self, now_s: float) -> None:
        if self._loop is None or now_s < self._next_census_s:
            return
        self._next_census_s = now_s + CENSUS_S
        found = self._loop.census()
        if found is not None:
            self._say(language.THERE, found)

    def _go_on(self) -> None:
        """Hand over what waits, as far as there is room."""
        try:
            self._wire.flush()
        except OSError:
            self.leave()
        update = self._waiting
        if update is not None and not self._wire.is_behind:
            self._waiting = None
            self._say(language.UPDATE, self._shortener.shortened(update))

    def _say(self, *words: object) -> None:
        try:
            pieces = packed(words)
        except PlainError as problem:
            if words[0] == language.UPDATE:
                raise
            pieces = packed((language.FAILED, words[1], ObserverError(str(problem))))
        try:
            self._wire.send(pieces)
        except OSError:
            self.leave()

    def _say_at_last(self, *words: object) -> None:
        until_s = time.monotonic() + LAST_WORDS_S
        self._go_on()
        self._say(*words)
        while self._wire.is_behind and time.monotonic() < until_s:
            time.sleep(0.01)
            with suppress(OSError):
                self._wire.flush()

    def leave(self) -> None:
        if not self._over:
            self._over = True
            self._alarm(LEFT_WITHIN_S)
        if self._loop is not None:
            self._loop.stop()


def _without_late(result: CallResult) -> CallResult:
    from dataclasses import replace

    return replace(result, late=None)


def serve(wire: Wire) -> None:
    """Serve, and end this process: nothing of the middleware may hold up its end."""
    gc.set_threshold(GARBAGE_AFTER)
    server = Server(wire, signal.alarm)
    signal.signal(signal.SIGTERM, lambda *_: server.leave())
    code = 1
    try:
        server.run()
        code = 0
    except Exception:  # noqa: BLE001 - the last chance to say it
        traceback.print_exc()
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code)
