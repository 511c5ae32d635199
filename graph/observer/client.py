"""The screen's side of the observer's process: a thread that listens, and makes it anew.

No method waits for the process, whatever that does: orders go to its socket, or wait here. When it
has died, or hangs, another takes its place, and gets the same orders; what was under way fails.
"""

from __future__ import annotations

import itertools
import logging
import os
import select
import threading
import time
from contextlib import suppress
from dataclasses import astuple, dataclass, field, replace
from typing import TYPE_CHECKING, Any

from graph.data import GraphUpdate
from graph.memory import keep_room_for_large_messages
from graph.observer.asked import AskedBook, OpenOrder
from graph.observer.doubt import Doubt, SecondLook
from graph.observer.lost import LostWork
from graph.observer.process import language
from graph.observer.process.plain import PlainError
from graph.observer.process.started import ObserverProcess, take_ahead
from graph.observer.process.updates import Lengthener
from graph.observer.requests import ObserverError
from graph.observer.vigil import LOOK_S, Vigil
from text.sentences import Words, say

if TYPE_CHECKING:
    from collections.abc import Callable
    from concurrent.futures import Future

    from graph.observer.census import Census
    from graph.observer.process.language import Order
    from graph.observer.settings import ObserverSettings

logger = logging.getLogger(__name__)

LEAVES_WITHIN_S = 5.0
"""How long a process may take to leave the graph before it is killed."""
DISMISSED_WITHIN_S = 2.0
"""The same of one that has only looked."""
SETTLED_AFTER_S = 2.0
"""A process that was made anew has found most of what there is by then."""
AGAIN_S = (0.0, 0.5, 1.0, 2.0, 5.0, 10.0)
"""How long to wait before another is started, the more of them have died one after the other."""
LASTED_S = 20.0
"""One that has lived so long has not died of its start."""


@dataclass
class _Line:
    """One process, and what is known by it."""

    process: ObserverProcess
    is_first: bool
    began_s: float = field(default_factory=time.monotonic)
    vigil: Vigil = field(default_factory=lambda: Vigil(time.monotonic()))
    rows: Lengthener = field(default_factory=Lengthener)
    update: GraphUpdate | None = None
    """Its newest."""
    why: Words = field(default_factory=lambda: say("the process that watches the graph has died"))
    """Why it is no longer listened to."""
    refusal: ObserverError | None = None
    """Why there need not be another."""
    there: Census | None = None
    """Who is there by it."""
    doubt: Doubt = field(default_factory=lambda: Doubt(time.monotonic()))
    other: _Line | None = None
    """A second one that looks whether it sees more."""
    is_outdone: bool = False
    """Whether it does."""
    look: SecondLook = field(default_factory=lambda: SecondLook(time.monotonic()))
    """How that is compared with the first."""


class ObserverClient:
    """Has a process at work from `start` to `stop`; all methods may be called from any thread."""

    started: Callable[[], ObserverProcess] = staticmethod(lambda: take_ahead() or ObserverProcess())
    """Starts a process; raises OSError."""

    def __init__(self, settings: ObserverSettings) -> None:
        self._settings = settings
        self._numbers = itertools.count(1)
        self._asked = AskedBook()
        self._lock = threading.Lock()
        """For those below, as far as the socket."""
        self._wake = -1
        """Readable when the thread has something to do."""
        self._line: _Line | None = None
        self._unsent: list[Order] = []
        self._wanted: dict[str, Any] = {}
        self._prepared: dict[tuple[Any, ...], Order] = {}
        self._failure: ObserverError | None = None
        self._over = False
        self._thread: threading.Thread | None = None
        self._on_update: Callable[[GraphUpdate], None] = lambda _: None
        self._lost = LostWork()
        self._shown: GraphUpdate | None = None
        self._is_to_show = False
        """Whether what is shown has changed without an update."""
        self._old_since_s: float | None = None
        """Unix time of the last sign of life, while what is shown is old."""

    def start(self, on_update: Callable[[GraphUpdate], None]) -> None:
        """Start the thread, which calls `on_update`."""
        self._on_update = on_update
        self._wake = os.eventfd(0, os.EFD_CLOEXEC | os.EFD_NONBLOCK)
        self._thread = threading.Thread(target=self._run, name="deck-observer", daemon=True)
        self._thread.start()

    def stop(self) -> None:
        """Have the process leave; return once it has, or was killed. Whatever waits fails."""
        self._over = True
        with self._lock:
            self._rouse()
        if self._thread is None:
            self._end(ObserverError(say("the observer was never started")))
        elif self._thread is not threading.current_thread():
            self._thread.join()

    def want(self, name: str, value: object) -> None:
        """Give an order of which the newest counts."""
        with self._lock:
            if name not in self._wanted or self._wanted[name] != value:
                self._wanted[name] = value
                self._send((0, name, (value,), 0.0))

    def tell(self, name: str, *arguments: Any) -> None:  # noqa: ANN401
        """Give an order that nobody waits for."""
        with self._lock:
            if self._lost.heed(name, *arguments):
                self._is_to_show = True
                self._rouse()
            self._send((0, name, arguments, time.monotonic()))

    def ask(
        self,
        name: str,
        *arguments: Any,  # noqa: ANN401
        refusal: Callable[[Exception], Any] | None = None,
    ) -> Future[Any]:
        """Give an order; the future gets its answer, or an ObserverError.

        `refusal` makes the result of a future that must not raise.
        """
        asked = OpenOrder(next(self._numbers), name, arguments, refusal)
        asked.future.add_done_callback(lambda done: self._look_at_end(asked.number, done))
        failure = self._try(asked)
        if failure is not None:
            asked.fail(failure)
        return asked.future

    def _try(self, asked: OpenOrder) -> ObserverError | None:
        with self._lock:
            if self._failure is not None:
                return self._failure
            self._asked.add(asked)
            if asked.name in language.PREPARING:
                self._prepared[(asked.name, *asked.arguments)] = (0, *asked.order[1:])
            try:
                self._send(asked.order)
            except PlainError as problem:
                self._asked.drop(asked.number)
                return ObserverError(str(problem))
        return None

    def _look_at_end(self, number: int, future: Future[Any]) -> None:
        if future.cancelled() and self._asked.drop(number) is not None:
            with self._lock:
                self._send((0, language.DROP, (number,), 0.0))

    def _send(self, order: Order) -> None:
        """Send it, or keep it for a process to come; under the lock. Raises PlainError."""
        if self._line is not None:
            self._line.process.send(order)
            if self._line.process.wire.is_behind:
                self._rouse()
        elif order[1] not in language.WANTED and self._failure is None:
            self._unsent.append(order)

    def _rouse(self) -> None:
        if self._wake >= 0:
            os.eventfd_write(self._wake, 1)

    # ------------------------------------------------------------------ on the thread

    def _run(self) -> None:
        keep_room_for_large_messages()
        end = ObserverError(say("the observer has been stopped"))
        deaths, after = 0, None
        try:
            while not self._over:
                line = self._begin(after)
                after = None
                self._listen(line)
                if self._over or line.refusal is not None:
                    end = line.refusal or end
                    self._leave(line)
                    return
                if line.is_outdone:
                    after, line.other = line.other, None
                    self._hand_on(line)
                    continue
                deaths = 1 + (deaths if time.monotonic() - line.began_s < LASTED_S else 0)
                self._lose(line)
                self._rest(AGAIN_S[min(deaths, len(AGAIN_S)) - 1])
        except OSError as error:
            end = ObserverError(say("ROS cannot be used: {error}", error=str(error)))
            self._hand_over(GraphUpdate(time.time(), error=end.words))
        finally:
            self._end(end)

    def _open(self) -> _Line:
        """Start a process for the domain. Raises OSError."""
        line = _Line(self.started(), is_first=self._shown is None)
        line.process.send((0, language.OPEN, (astuple(self._settings),), 0.0))
        return line

    def _begin(self, opened: _Line | None) -> _Line:
        """Tell a process what is wanted, one that is there or a new one. Raises OSError."""
        line = opened or self._open()
        with self._lock:
            line.process.send((0, language.NUMBER, (self._lost.next_number,), 0.0))
            for name, value in self._wanted.items():
                line.process.send((0, name, (value,), 0.0))
            for order in self._unsent:
                line.process.send(order)
            self._unsent.clear()
            self._line = line
        if line.update is not None:
            self._hand_over(line.update)
        return line

    def _listen(self, line: _Line) -> None:
        """Return when it has ended, or hangs, or is no longer wanted."""
        while not self._over and line.refusal is None:
            line.process.wait(self._wake, LOOK_S)
            if not self._hear(line):
                return
            now_s = time.monotonic()
            if line.vigil.hangs(now_s, lambda: line.process.is_ready_to_run):
                line.why = say("the process that watches the graph has hung")
                return
            self._show_age(line, now_s)
            if self._look_again(line, now_s):
                return
        self._dismiss(line)

    def _look_again(self, line: _Line, now_s: float) -> bool:
        """Have a second process look while there is doubt; return whether it sees more."""
        if line.there is None:
            return False
        if line.other is None:
            if line.doubt.is_due(now_s, line.there.is_networked):
                line.other, line.look = self._open(), SecondLook(now_s)
            return False
        other = line.other
        other.process.wait(self._wake, 0.0)
        gone = not self._hear(other)
        if other.there is not None and line.look.sees_more(line.there, other.there, now_s):
            line.is_outdone = not gone
            return True
        if gone or other.refusal is not None or line.look.is_over(now_s):
            line.doubt.nothing_found(now_s)
            self._dismiss(line)
        return False

    def _dismiss(self, line: _Line) -> None:
        other, line.other = line.other, None
        if other is not None:
            other.process.send((0, language.LEAVE, (), 0.0))
            other.process.end(DISMISSED_WITHIN_S)

    def _hear(self, line: _Line) -> bool:
        """Take what it has said, and send what had no room; return whether it is still there."""
        with suppress(BlockingIOError):
            os.eventfd_read(self._wake)
        with self._lock:
            line.process.flush()
        try:
            said = line.process.receive()
        except (EOFError, PlainError):
            return False
        if said:
            line.vigil.sign(time.monotonic())
        for words in said:
            self._take(line, *words)
        return True

    def _take(self, line: _Line, word: str, *told: Any) -> None:  # noqa: ANN401
        if word == language.UPDATE:
            line.update = line.rows.update(*told)
            if line is self._line:
                self._hand_over(line.update)
        elif word == language.THERE:
            line.there = told[0]
            line.doubt.see(line.there, time.monotonic())
        elif word == language.OVER:
            line.refusal = told[0]
        elif word == language.DONE:
            self._asked.done(*told)
        elif word == language.FAILED:
            self._asked.failed(*told)
        elif word == language.LATER:
            self._asked.later(*told)

    def _show_age(self, line: _Line, now_s: float) -> None:
        """Say since when what is shown is old, or that it no longer is."""
        silent_since_s = line.vigil.old_since_s(now_s)
        settled = line.is_first or now_s - line.began_s > SETTLED_AFTER_S
        if silent_since_s is not None:
            self._grow_old(time.time() - (now_s - silent_since_s))
        elif self._old_since_s is not None and line.update is not None and settled:
            self._old_since_s, self._is_to_show = None, True
        if self._is_to_show:
            self._is_to_show = False
            self._hand_over(None)

    def _grow_old(self, since_s: float) -> None:
        if self._old_since_s is None and self._shown is not None:
            self._old_since_s, self._is_to_show = since_s, True

    def _hand_over(self, update: GraphUpdate | None) -> None:
        """Show an update, or once more the one that is shown, with what has changed here."""
        shown = update or (None if self._shown is None else replace(self._shown, samples={}))
        if shown is None:
            return
        self._shown = shown
        with self._lock:
            shown = self._lost.added_to(shown)
        if self._old_since_s is not None:
            shown = replace(shown, old_since_s=self._old_since_s)
        try:
            self._on_update(shown)
        except Exception:
            # The screen is being closed; the observer is stopped next.
            logger.exception("an update was not taken")

    def _hand_on(self, line: _Line) -> None:
        """Have done with a process that sees less than another."""
        line.why = say("another observer has taken over, which sees more of the graph")
        self._leave(line)
        self._forget(line)

    def _lose(self, line: _Line) -> None:
        """Have done with a process that has ended or hangs, and make ready for another."""
        self._dismiss(line)
        line.process.kill()
        self._grow_old(time.time())
        self._forget(line)

    def _forget(self, line: _Line) -> None:
        """Say of what is under way that it has ended, and keep what the next process needs to know."""
        with self._lock:
            self._line = None
            ended = () if line.update is None else self._lost.lose(line.update, line.why)
            repeated = list(self._prepared.values())
            # A robot must not drive on to a goal that nobody follows any more.
            repeated += [(0, "cancel_lost_goal", (goal.action, goal.type_name, goal.goal_id), 0.0) for goal in ended]
            self._unsent[:0] = repeated
        kept = self._asked.fail_lost(ObserverError(line.why))
        with self._lock:
            self._unsent[len(repeated) : len(repeated)] = [asked.order for asked in kept]
        self._is_to_show = False
        self._hand_over(None)

    def _rest(self, within_s: float) -> None:
        waiting = select.poll()
        waiting.register(self._wake, select.POLLIN)
        until_s = time.monotonic() + within_s
        while not self._over and (left_s := until_s - time.monotonic()) > 0.0:
            waiting.poll(left_s * 1000.0)
            with suppress(BlockingIOError):
                os.eventfd_read(self._wake)

    def _leave(self, line: _Line) -> None:
        """Have it leave, and hear what it still has to say of what is under way."""
        until_s = time.monotonic() + LEAVES_WITHIN_S
        with self._lock:
            line.process.send((0, language.LEAVE, (), 0.0))
        while time.monotonic() < until_s:
            line.process.wait(self._wake, LOOK_S)
            if not self._hear(line):
                break
        with self._lock:
            self._line = None
        line.process.end(max(0.0, until_s - time.monotonic()))

    def _end(self, error: ObserverError) -> None:
        with self._lock:
            self._failure = error
            self._unsent.clear()
            if self._wake >= 0:
                os.close(self._wake)
                self._wake = -1
        self._asked.fail_all(error)
