"""Requests to the observer, and the queue that they wait in until its loop carries them out."""

from __future__ import annotations

import threading
import time
from collections import deque
from concurrent.futures import Future
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Generic, NamedTuple, Protocol, TypeVar

from graph.data import CallResult
from text.sentences import reason_of

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from graph.data import Value
    from graph.observer.node import ObserverNode

T = TypeVar("T")


class ObserverError(Exception):
    """The observer cannot work, or has been stopped; `words` says why."""

    def __init__(self, words: str) -> None:
        """Store the reason, made by `text.sentences.say`."""
        super().__init__(words)
        self.words = words


class Request(Protocol):
    """Something to be done in the observer's loop."""

    def carry_out(self, node: ObserverNode) -> None:
        """Perform it; may raise anything."""

    def fail(self, error: Exception) -> None:
        """Say that it cannot be done."""


class UrgentRequest(NamedTuple):
    """A request that may be carried out in the middle of a poll, once its needs are met."""

    request: Request
    ready: Callable[[ObserverNode], bool]
    """Whether it no longer needs a look at the graph."""


@dataclass(frozen=True)
class PreparePublisher:
    """Make a publisher."""

    topic: str
    type_name: str
    latched: bool
    future: Future[None] = field(default_factory=Future)

    def carry_out(self, node: ObserverNode) -> None:
        ends = node.ends(self.topic)
        node.outbox.prepare(self.topic, self.type_name, ends, latched=self.latched)
        self.future.set_result(None)

    def fail(self, error: Exception) -> None:
        """Say that it cannot be done."""
        self.future.set_exception(error)


@dataclass(frozen=True)
class SendMessage:
    """Publish one message."""

    topic: str
    type_name: str
    value: Mapping[str, Value]
    latched: bool
    future: Future[int] = field(default_factory=Future)

    def carry_out(self, node: ObserverNode) -> None:
        """Do it, unless it was cancelled meanwhile."""
        if self.future.set_running_or_notify_cancel():
            # An emergency stop must not wait for a look at the graph, which takes its time.
            ready = self.latched and node.outbox.knows_latched(self.topic, self.type_name)
            ends = None if ready else node.ends(self.topic)
            node.outbox.publish(self.topic, self.type_name, self.value, ends, self.future, latched=self.latched)

    def fail(self, error: Exception) -> None:
        """Say that it cannot be done."""
        if not self.future.cancelled():
            self.future.set_exception(error)


@dataclass(frozen=True)
class CallService:
    """Call a service."""

    service: str
    type_name: str
    request: Mapping[str, Value]
    timeout_s: float
    asked_s: float = field(default_factory=time.monotonic)
    future: Future[CallResult] = field(default_factory=Future)

    def carry_out(self, node: ObserverNode) -> None:
        """Do it, unless it was cancelled meanwhile."""
        if self.future.set_running_or_notify_cancel():
            node.calls.begin(
                self.service,
                self.type_name,
                self.request,
                node.service(self.service),
                self.future,
                self.timeout_s,
                self.asked_s,
            )

    def fail(self, error: Exception) -> None:
        """Say that it cannot be done."""
        if not self.future.cancelled():
            elapsed_s = time.monotonic() - self.asked_s
            refused = CallResult(self.service, False, None, reason_of(error), elapsed_s)
            self.future.set_result(refused)


@dataclass(frozen=True)
class Perform:
    """Do something that nobody waits for; without an observer nothing is done."""

    act: Callable[[ObserverNode], None]

    def carry_out(self, node: ObserverNode) -> None:
        self.act(node)

    def fail(self, error: Exception) -> None:
        """Do nothing: its subject has ended with the observer."""


@dataclass(frozen=True)
class Begin(Generic[T]):
    """Start something whose end a future reports."""

    begin: Callable[[ObserverNode, Future[T]], None]
    """Called in the observer's loop; may raise anything."""
    refusal: Callable[[Exception], T] | None = None
    """Makes the result that says why not, for a future that must never raise."""
    future: Future[T] = field(default_factory=Future)

    def carry_out(self, node: ObserverNode) -> None:
        """Begin it, unless it was cancelled meanwhile."""
        if self.future.set_running_or_notify_cancel():
            self.begin(node, self.future)

    def fail(self, error: Exception) -> None:
        """Say that it cannot be done."""
        if self.future.cancelled():
            return
        if self.refusal is not None:
            self.future.set_result(self.refusal(error))
        else:
            self.future.set_exception(error)


class RequestQueue:
    """Takes requests on any thread; the observer's loop carries them out."""

    def __init__(self) -> None:
        self._requests: deque[Request] = deque()
        self._urgent: deque[UrgentRequest] = deque()
        self._lock = threading.Lock()
        self._failure: ObserverError | None = None

    def put(self, request: Request) -> None:
        """Queue a request, to be carried out in its turn, between two looks at the graph."""
        self._put(self._requests, request, request)

    def hurry(self, request: Request, ready: Callable[[ObserverNode], bool] | None = None) -> None:
        """Queue a request before all others; it may interrupt a look if it is `ready`."""
        self._put(self._urgent, UrgentRequest(request, ready or _always), request)

    def carry_out(self, node: ObserverNode) -> None:
        while self._urgent or self._requests:
            request = self._urgent.popleft().request if self._urgent else self._requests.popleft()
            _carry_out(request, node)

    def carry_out_urgent(self, node: ObserverNode) -> None:
        """Do what cannot wait for the end of a look, unless it needs a look itself."""
        while self._urgent and self._urgent[0].ready(node):
            _carry_out(self._urgent.popleft().request, node)

    def refuse(self, failure: ObserverError) -> None:
        """Fail all pending requests, and all requests from now on."""
        with self._lock:
            self._failure = failure
        while self._urgent:
            self._urgent.popleft().request.fail(failure)
        while self._requests:
            self._requests.popleft().fail(failure)

    def _put(self, queue: deque[T], entry: T, request: Request) -> None:
        with self._lock:
            failure = self._failure
            if failure is None:
                queue.append(entry)
        if failure is not None:
            request.fail(failure)


def _always(_node: ObserverNode) -> bool:
    return True


def _carry_out(request: Request, node: ObserverNode) -> None:
    try:
        request.carry_out(node)
    except Exception as error:  # noqa: BLE001 - reported to the caller
        request.fail(error)
