"""The observer: it watches the graph for the screen, by a process of its own.

rclpy can hang with Python's lock held, and the screen must still stop the wheels. So no method of the observer waits
for that process, whatever it does. When it has died, or hangs, another takes its place: it gets what is wanted, what
was prepared, and the latched messages that were not confirmed, such as a stop; everything else that was under way
fails in words. Meanwhile updates say since when they are old.
"""

from __future__ import annotations

import atexit
import contextlib
import itertools
import logging
import os
import pickle
import queue
import signal
import socket
import struct
import subprocess
import sys
import threading
import time
from concurrent.futures import Future, InvalidStateError
from dataclasses import dataclass, field, replace
from multiprocessing.connection import Connection, wait
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from graph.data import GoalStatus, GraphUpdate, Interest
from graph.memory import keep_room_for_large_messages
from graph.observer.requests import (
    Answer,
    CancelSeenGoal,
    ForgetGoal,
    ObserverError,
    Opening,
    Order,
    PrepareHold,
    PreparePublisher,
    Request,
    StopPublishing,
    StopPublishingAll,
    refuse,
)
from graph.observer.updates import renewed
from text.i18n import N_
from text.sentences import Words, say

if TYPE_CHECKING:
    from collections.abc import Callable

    from graph.data import CallResult, Goal, Publication

logger = logging.getLogger(__name__)

T = TypeVar("T")
PROGRAM = (
    "import sys; sys.path[:] = sys.argv[3:]; "
    "from graph.observer.process import main; main(int(sys.argv[1]), int(sys.argv[2]))"
)
OLD_AFTER_S = 3.0
"""Without a sign for so long, what is known of the graph is old; one is due each second."""
HUNG_AFTER_S = 8.0
"""A process that could run and has given no sign for so long hangs."""
GIVEN_UP_AFTER_S = 60.0
"""No machine is so busy that a process does not get to it within this, or does not start."""
LOOK_S = 0.5
"""How often to look."""
LEAVES_WITHIN_S = 5.0
"""How long a process may take to leave the graph before it is killed."""
SETTLED_AFTER_S = 2.0
"""A process that was made anew has found most of what there is by then."""
AGAIN_S = (0.0, 0.5, 1.0, 2.0, 5.0, 10.0)
"""How long to wait before another is started, the more of them have died one after the other."""
LASTED_S = 20.0
"""One that has lived so long has not died of its start."""
HUNG = N_("the process that watches the graph has hung")
_READ_BYTES = 1 << 16
_ahead: list[ObserverProcess] = []


class ObserverProcess:
    """One that was started here. It dies with the thread that has started it."""

    def __init__(self) -> None:
        """Start it; it imports rclpy, and waits. Raises OSError if that is impossible."""
        ours, theirs = socket.socketpair()
        # Whoever stops in the middle of a word hangs: it is not waited for any longer.
        ours.setsockopt(socket.SOL_SOCKET, socket.SO_RCVTIMEO, struct.pack("@ll", int(HUNG_AFTER_S), 0))
        with theirs, contextlib.ExitStack() as opening:
            streams: dict[int, int] = {}
            ends = []
            for number in (1, 2):
                reading, writing = os.pipe2(os.O_CLOEXEC | os.O_NONBLOCK)
                opening.callback(os.close, writing)
                streams[reading] = number
                ends.append(writing)
            self._process = subprocess.Popen(
                [sys.executable, "-c", PROGRAM, str(theirs.fileno()), str(os.getpid()), *sys.path],
                stdin=subprocess.DEVNULL,
                stdout=ends[0],
                stderr=ends[1],
                pass_fds=(theirs.fileno(),),
                start_new_session=True,
            )
        self._begin(Connection(ours.detach()), streams)

    def _begin(self, end: Connection, streams: dict[int, int]) -> None:
        self._end = end
        self._streams = streams
        """What it prints, by a descriptor here, goes to which."""
        self._unsent: queue.SimpleQueue[bytes | None] = queue.SimpleQueue()
        threading.Thread(target=self._send, name="deck-observer-orders", daemon=True).start()

    @property
    def pid(self) -> int:
        return self._process.pid

    @property
    def is_alive(self) -> bool:
        return self._process.poll() is None

    @property
    def is_ready_to_run(self) -> bool:
        """Whether it only waits for a processor, or for the disk: it does not hang."""
        with contextlib.suppress(OSError):
            stat = Path(f"/proc/{self.pid}/stat").read_text(errors="replace")
            return stat.rpartition(")")[2].split()[0] in "RD"
        return False

    def send(self, words: object) -> None:
        """Send something, without waiting for it; raises what pickling raises."""
        self._unsent.put(pickle.dumps(words))

    def hear(self, within_s: float) -> list[Any]:
        """Wait, so long at most, and return what it has said.

        Raises EOFError if it has ended, BlockingIOError if it has stopped in the middle of a word.
        """
        said: list[Any] = []
        for ready in wait([self._end, *self._streams], within_s):
            if isinstance(ready, int):
                self._pass_on(ready)
        try:
            while self._end.poll():
                said.append(self._end.recv())
        except (EOFError, ConnectionError) as error:
            if not said:
                raise EOFError from error
        except BlockingIOError:
            raise
        except Exception as error:
            # What cannot be read is no better than no word: another process takes its place.
            raise EOFError from error
        return said

    def end(self, within_s: float) -> None:
        """Wait for its end, so long at most, and kill it then."""
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._process.wait(within_s)
        self.kill()

    def kill(self) -> None:
        if self._process.poll() is None:
            self._process.send_signal(signal.SIGKILL)
            self._process.wait()
        self._unsent.put(None)
        for descriptor in tuple(self._streams):
            self._pass_on(descriptor)
            if self._streams.pop(descriptor, None):
                os.close(descriptor)

    def _send(self) -> None:
        """Send on a thread of its own: a process that hangs reads nothing."""
        with self._end:
            while (raw := self._unsent.get()) is not None:
                # Whoever listens finds out that nobody is there.
                with contextlib.suppress(OSError):
                    self._end.send_bytes(raw)

    def _pass_on(self, descriptor: int) -> None:
        """Print what it has printed: where that goes may have changed since it was started."""
        try:
            printed = os.read(descriptor, _READ_BYTES)
        except BlockingIOError:
            return
        if not printed:
            del self._streams[descriptor]
            os.close(descriptor)
            return
        with contextlib.suppress(OSError):
            os.write(self._streams[descriptor], printed)


def start_ahead() -> None:
    """Start one for the next observer, by the main thread, which lives as long as this process."""
    if threading.current_thread() is threading.main_thread() and not _ahead:
        with contextlib.suppress(OSError):
            _ahead.append(ObserverProcess())
            atexit.register(give_up_ahead)


def take_ahead() -> ObserverProcess | None:
    """Return the one that was started ahead, if there is one at work."""
    with contextlib.suppress(IndexError):
        process = _ahead.pop()
        if process.is_alive:
            return process
        process.kill()
    return None


def give_up_ahead() -> None:
    """End the one that was started ahead, if nobody has taken it."""
    process = take_ahead()
    if process is not None:
        process.kill()


@dataclass(frozen=True)
class _Asked:
    """One request and who waits for its answer."""

    order: Order
    future: Future[Any] = field(default_factory=Future)

    def fail(self, error: Exception) -> None:
        refuse(self.order.request, self.future, error, time.monotonic() - self.order.asked_s)


@dataclass
class _Line:
    """One process, and what is known by it."""

    process: ObserverProcess
    is_first: bool
    began_s: float = field(default_factory=time.monotonic)
    silent_s: float = 0.0
    has_spoken: bool = False
    update: GraphUpdate | None = None
    """Its newest."""
    why: Words = field(default_factory=lambda: say("the process that watches the graph has died"))
    """Why it is no longer listened to."""
    refusal: ObserverError | None = None
    """Why there need not be another."""

    def hangs(self) -> bool:
        """Return whether it has been silent for too long; while it only lacks a processor it may be for longer."""
        if self.silent_s <= HUNG_AFTER_S:
            return False
        return self.silent_s > GIVEN_UP_AFTER_S or (self.has_spoken and not self.process.is_ready_to_run)


class _LostWork:
    """Goals and publications that have ended with the process that was at them, until forgotten."""

    def __init__(self) -> None:
        self.next_number = 1
        """Goals and publications of the next process are numbered beyond those of the last."""
        self._goals: dict[int, Goal] = {}
        self._publications: dict[int, Publication] = {}

    def lose(self, update: GraphUpdate, why: str) -> list[Goal]:
        """Take over what the last update of a process has; return the goals that were under way."""
        for goal in update.goals:
            self._goals[goal.number] = goal if goal.ended else replace(goal, status=GoalStatus.FAILED, error=why)
        for one in update.publications:
            self._publications[one.number] = one if one.error else replace(one, error=why)
        self.next_number = max((self.next_number, *(1 + number for number in (*self._goals, *self._publications))))
        return [goal for goal in update.goals if not goal.ended]

    def added_to(self, update: GraphUpdate) -> GraphUpdate:
        if not (self._goals or self._publications):
            return update
        goals = {**{goal.number: goal for goal in update.goals}, **self._goals}
        ones = {**{one.number: one for one in update.publications}, **self._publications}
        return replace(
            update,
            goals=tuple(goals[number] for number in sorted(goals)),
            publications=tuple(ones[number] for number in sorted(ones)),
        )

    def heed(self, request: Request[Any]) -> bool:
        """Heed a request to stop or to forget; return whether one of these is gone by it."""
        before = len(self._goals) + len(self._publications)
        if isinstance(request, ForgetGoal):
            self._goals.pop(request.number, None)
        elif isinstance(request, StopPublishing):
            self._publications.pop(request.number, None)
        elif isinstance(request, StopPublishingAll):
            self._publications.clear()
        return len(self._goals) + len(self._publications) < before


class Observer:
    """The ROS graph of one domain as plain data. All methods may be called from any thread."""

    start_process: Callable[[], ObserverProcess] = staticmethod(lambda: take_ahead() or ObserverProcess())
    """Starts a process; raises OSError."""

    def __init__(
        self,
        domain: int,
        discovery: str | tuple[str, ...] = "localhost",
        *,
        graph_s: float = 0.25,
        role: str = "observer",
    ) -> None:
        """Prepare for a domain; `discovery` is localhost, subnet, or the addresses of peers.

        `graph_s`: seconds between two looks at who is there, which cost more than those at messages; 0.25 is often
        enough for a reader of the screen
        `role`: part of the node's name, see `graph.ros.ONLY_LISTENING`
        """
        self._opening = Opening(domain, discovery, graph_s, role, os.getpid())
        self._numbers = itertools.count(1)
        self._lock = threading.RLock()
        """For all that is not the thread's alone."""
        self._wanted = Interest()
        self._line: _Line | None = None
        self._unsent: list[_Asked] = []
        self._prepared: dict[Request[Any], None] = {}
        self._waiting: dict[int, _Asked] = {}
        self._late: dict[int, Future[CallResult]] = {}
        """Answers to calls that have timed out, should they still come."""
        self._lost = _LostWork()
        self._failure: ObserverError | None = None
        self._over = threading.Event()
        self._thread: threading.Thread | None = None
        self._on_update: Callable[[GraphUpdate], None] = lambda _: None
        self._shown: GraphUpdate | None = None
        self._is_to_show = False
        """Whether what is shown has changed without an update."""
        self._old_since_s: float | None = None
        """Unix time of the last sign of life, while what is shown is old."""

    def start(self, on_update: Callable[[GraphUpdate], None]) -> None:
        """Start observing; `on_update` is called on a thread of the observer.

        Requests made earlier, or while rclpy is being imported, are served as soon as it is loaded.
        """
        # It leaves the graph properly, while there is time for that.
        atexit.register(self.stop)
        self._on_update = on_update
        self._thread = threading.Thread(target=self._run, name="deck-observer", daemon=True)
        self._thread.start()

    def stop(self) -> None:
        """Leave the graph; what is under way fails. Always returns within a few seconds."""
        atexit.unregister(self.stop)
        with self._lock:
            self._over.set()
            if self._line is not None:
                self._line.process.send(None)
        if self._thread is None:
            self._end(ObserverError(say("the observer was never started")))
        elif self._thread is not threading.current_thread():
            self._thread.join()

    @property
    def wanted(self) -> Interest:
        """What updates are to have."""
        return self._wanted

    def want(self, interest: Interest) -> None:
        """Have updates with exactly this from now on."""
        with self._lock:
            if interest != self._wanted:
                self._wanted = interest
                if self._line is not None:
                    self._line.process.send(interest)

    def ask(self, request: Request[T]) -> Future[T]:
        """Ask for something; the future gets the answer, or ObserverError, and what the request says that it raises.

        Once it is cancelled, nobody waits for it; what has not been sent yet is not done.
        """
        asked = _Asked(Order(next(self._numbers), request, time.monotonic()))
        with self._lock:
            self._is_to_show |= self._lost.heed(request)
            failure = self._failure
            if failure is None:
                self._waiting[asked.order.number] = asked
                if isinstance(request, (PreparePublisher, PrepareHold)):
                    self._prepared[request] = None
                failure = self._send(asked)
        if failure is not None:
            asked.fail(failure)
        return asked.future

    def _send(self, asked: _Asked) -> ObserverError | None:
        """Send it, or keep it for a process to come; return why that is impossible."""
        if self._line is None:
            self._unsent.append(asked)
            return None
        try:
            self._line.process.send(asked.order)
        except Exception as problem:  # noqa: BLE001 - whatever is not plain data raises when it is pickled
            self._waiting.pop(asked.order.number, None)
            return ObserverError(str(problem))
        return None

    # ------------------------------------------------------------------ on the thread

    def _run(self) -> None:
        keep_room_for_large_messages()
        end = ObserverError(say("the observer has been stopped"))
        deaths = 0
        try:
            while not self._over.is_set():
                line = self._begin()
                self._listen(line)
                if self._over.is_set() or line.refusal is not None:
                    self._leave(line)
                    end = line.refusal or end
                    break
                deaths = 1 + (deaths if time.monotonic() - line.began_s < LASTED_S else 0)
                self._lose(line)
                self._over.wait(AGAIN_S[min(deaths, len(AGAIN_S)) - 1])
        except OSError as error:
            end = ObserverError(say("ROS cannot be used: {error}", error=str(error)))
            self._hand_over(GraphUpdate(time.time(), error=end.words))
        finally:
            self._end(end)

    def _begin(self) -> _Line:
        """Start a process, and tell it what is wanted. Raises OSError."""
        line = _Line(self.start_process(), is_first=self._shown is None)
        with self._lock:
            line.process.send(replace(self._opening, first_number=self._lost.next_number))
            line.process.send(self._wanted)
            self._line = line
            unsent, self._unsent = self._unsent, []
            failures = [(one, self._send(one)) for one in unsent if not one.future.cancelled()]
        for asked, failure in failures:
            if failure is not None:
                asked.fail(failure)
        return line

    def _listen(self, line: _Line) -> None:
        """Return when it has ended, or hangs, or is no longer wanted."""
        before_s = time.monotonic()
        while not self._over.is_set() and line.refusal is None:
            try:
                said = line.process.hear(LOOK_S)
            except EOFError:
                return
            except BlockingIOError:
                line.why = say(HUNG)
                return
            now_s = time.monotonic()
            # If this process could not run, it says nothing of the other that nothing has been heard.
            line.silent_s = 0.0 if said else line.silent_s + min(now_s - before_s, LOOK_S)
            before_s = now_s
            for words in said:
                self._take(line, words)
            if line.hangs():
                line.why = say(HUNG)
                return
            self._show_age(line)

    def _take(self, line: _Line, words: object) -> None:
        line.has_spoken = True
        if isinstance(words, dict):
            line.update = renewed(line.update or GraphUpdate(0.0), words)
            self._hand_over(line.update)
        elif isinstance(words, Answer):
            self._answer(words)
        elif isinstance(words, ObserverError):
            line.refusal = words
            self._hand_over(GraphUpdate(time.time(), error=words.words))

    def _answer(self, answer: Answer) -> None:
        with self._lock:
            asked = self._waiting.pop(answer.number, None)
        if asked is None:
            late = self._late.pop(answer.number, None)
            if late is not None:
                late.set_result(answer.result)
            return
        if answer.error is not None:
            asked.fail(answer.error)
            return
        result = answer.result
        if answer.is_first:
            self._late[answer.number] = Future()
            result = replace(result, late=self._late[answer.number])
        # It may have been cancelled.
        with contextlib.suppress(InvalidStateError):
            asked.future.set_result(result)

    def _show_age(self, line: _Line) -> None:
        """Say since when what is shown is old, or that it no longer is."""
        settled = line.is_first or time.monotonic() - line.began_s > SETTLED_AFTER_S
        if line.silent_s > OLD_AFTER_S:
            self._grow_old(time.time() - line.silent_s)
        elif self._old_since_s is not None and line.update is not None and settled:
            self._old_since_s, self._is_to_show = None, True
        if self._is_to_show:
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
            self._is_to_show = False
            shown = self._lost.added_to(shown)
        if self._old_since_s is not None:
            shown = replace(shown, old_since_s=self._old_since_s)
        try:
            self._on_update(shown)
        except Exception:
            # The screen is being closed; the observer is stopped next.
            logger.exception("an update was not taken")

    def _lose(self, line: _Line) -> None:
        """Have done with a process that has ended or hangs, and keep what the next one needs to know."""
        line.process.kill()
        self._grow_old(time.time())
        with self._lock:
            self._line = None
            ended = [] if line.update is None else self._lost.lose(line.update, line.why)
            # A robot must not drive on to a goal that nobody follows any more.
            cancelling = [CancelSeenGoal(goal.action, goal.goal_id, goal.type_name) for goal in ended]
            repeated = [_Asked(Order(0, request, time.monotonic())) for request in (*self._prepared, *cancelling)]
            kept = [asked for asked in self._waiting.values() if asked.order.request.lasts]
            lost = [asked for asked in self._waiting.values() if not asked.order.request.lasts]
            self._waiting = {asked.order.number: asked for asked in kept}
            self._unsent[:0] = [*repeated, *kept]
        self._late.clear()
        # The receiver may ask for something else at once.
        for asked in lost:
            asked.fail(ObserverError(line.why))
        self._hand_over(None)

    def _leave(self, line: _Line) -> None:
        """Have it leave, and hear what it still has to say of what is under way."""
        until_s = time.monotonic() + LEAVES_WITHIN_S
        line.process.send(None)
        with contextlib.suppress(EOFError, BlockingIOError):
            while time.monotonic() < until_s:
                for words in line.process.hear(LOOK_S):
                    self._take(line, words)
        with self._lock:
            self._line = None
        line.process.end(max(0.0, until_s - time.monotonic()))

    def _end(self, error: ObserverError) -> None:
        with self._lock:
            self._failure = error
            self._unsent.clear()
            waiting, self._waiting = list(self._waiting.values()), {}
        for asked in waiting:
            asked.fail(error)
