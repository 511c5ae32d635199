"""What the screen asks of the observer, on its way from one thread to the other."""

from __future__ import annotations

import time
from concurrent.futures import Future
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Generic, NamedTuple, Protocol, TypeVar

from graph.data import CallResult

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from graph.data import Value
    from graph.observer.station import Station

T = TypeVar("T")


class ObserverError(Exception):
    """The observer cannot work, or has been stopped; `words` says why."""

    def __init__(self, words: str) -> None:
        """Say why, as `graph.words.say` makes it."""
        super().__init__(words)
        self.words = words


class Order(Protocol):
    """Something to be done on the observer's thread."""

    def carry_out(self, station: Station) -> None:
        """Do it; may raise anything."""

    def fail(self, error: Exception) -> None:
        """Say that it cannot be done."""


class Urgent(NamedTuple):
    """An order that may be carried out in the middle of a look, once there is what it needs."""

    order: Order
    ready: Callable[[Station], bool]
    """Whether it needs no look at the graph any more."""


@dataclass(frozen=True)
class Prepare:
    """Make a publisher."""

    topic: str
    type_name: str
    latched: bool
    future: Future[None] = field(default_factory=Future)

    def carry_out(self, station: Station) -> None:
        """Do it."""
        ends = station.ends(self.topic)
        station.outbox.prepare(self.topic, self.type_name, ends, latched=self.latched)
        self.future.set_result(None)

    def fail(self, error: Exception) -> None:
        """Say that it cannot be done."""
        self.future.set_exception(error)


@dataclass(frozen=True)
class Publish:
    """Publish one message."""

    topic: str
    type_name: str
    value: Mapping[str, Value]
    latched: bool
    future: Future[int] = field(default_factory=Future)

    def carry_out(self, station: Station) -> None:
        """Do it, unless it was cancelled meanwhile."""
        if self.future.set_running_or_notify_cancel():
            # An emergency stop must not wait for a look at the graph, which takes its time.
            ready = self.latched and station.outbox.knows_latched(self.topic, self.type_name)
            ends = None if ready else station.ends(self.topic)
            station.outbox.publish(
                self.topic, self.type_name, self.value, ends, self.future, latched=self.latched
            )

    def fail(self, error: Exception) -> None:
        """Say that it cannot be done."""
        if not self.future.cancelled():
            self.future.set_exception(error)


@dataclass(frozen=True)
class Call:
    """Call a service."""

    service: str
    type_name: str
    request: Mapping[str, Value]
    timeout_s: float
    asked_s: float = field(default_factory=time.monotonic)
    future: Future[CallResult] = field(default_factory=Future)

    def carry_out(self, station: Station) -> None:
        """Do it, unless it was cancelled meanwhile."""
        if self.future.set_running_or_notify_cancel():
            station.calls.begin(
                self.service,
                self.type_name,
                self.request,
                station.service(self.service),
                self.future,
                self.timeout_s,
                self.asked_s,
            )

    def fail(self, error: Exception) -> None:
        """Say that it cannot be done."""
        if not self.future.cancelled():
            elapsed_s = time.monotonic() - self.asked_s
            self.future.set_result(CallResult(self.service, False, None, str(error), elapsed_s))


@dataclass(frozen=True)
class Do:
    """Have something done that nobody waits for; without an observer there is nothing to do."""

    act: Callable[[Station], None]

    def carry_out(self, station: Station) -> None:
        """Do it."""
        self.act(station)

    def fail(self, error: Exception) -> None:
        """Keep silent: what it was about has ended with the observer."""


@dataclass(frozen=True)
class Ask(Generic[T]):
    """Have something begun that has a future for its end."""

    begin: Callable[[Station, Future[T]], None]
    """Called on the observer's thread; may raise anything."""
    refusal: Callable[[Exception], T] | None = None
    """Makes the result that says why not, where the future is never to raise."""
    future: Future[T] = field(default_factory=Future)

    def carry_out(self, station: Station) -> None:
        """Begin it, unless it was cancelled meanwhile."""
        if self.future.set_running_or_notify_cancel():
            self.begin(station, self.future)

    def fail(self, error: Exception) -> None:
        """Say that it cannot be done."""
        if self.future.cancelled():
            return
        if self.refusal is not None:
            self.future.set_result(self.refusal(error))
        else:
            self.future.set_exception(error)
