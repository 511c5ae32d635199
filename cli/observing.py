"""A look at the ROS graph of a running domain by a command that then ends."""

from __future__ import annotations

import math
import queue
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from cli.domains import running_domain
from launcher.errors import UsageError
from text.output import keep_stdout_to_ourselves, say_error
from text.sentences import say

if TYPE_CHECKING:
    from graph.data import GraphUpdate
    from graph.observer.observer import Observer

FOUND_S = 4.0
"""A peer with the settings of ROS is found within this: it announces itself each 3 s."""
LOOK_S = 0.2
BEGIN_S = 20.0
"""On a busy machine the observer may take as long until it is in the domain."""


class DomainView:
    """What an observer tells of one domain."""

    def __init__(self, domain: int, discovery: str | tuple[str, ...], observer: Observer) -> None:
        self.domain = domain
        self.discovery = discovery
        self.observer = observer
        self._updates: queue.SimpleQueue[GraphUpdate] = queue.SimpleQueue()
        self.take = self._updates.put
        """Takes what the observer tells."""
        self._opened_s = time.monotonic()
        self._joined_s = self._news_s = math.inf
        """When the observer first told anything, and when it last told of something new."""
        self._size = (-1, 0, 0)

    def listened_s(self) -> float:
        """Return for how long the domain has been listened to; the start does not count."""
        now_s = time.monotonic()
        if now_s - self._opened_s >= BEGIN_S:
            # Nothing comes: whoever waits for that is not to wait for ever.
            return now_s - self._opened_s
        return max(0.0, now_s - self._joined_s)

    def is_at_rest(self) -> bool:
        """Return whether nothing new has been found for as long as a peer takes to be found."""
        return time.monotonic() - self._news_s >= FOUND_S

    def finds(self, node: str) -> bool:
        """Wait until the node of this full name is found, or a peer would have been.

        Raises:
            UsageError: if ROS cannot be used.
        """
        while self.listened_s() < FOUND_S:
            for update in self.updates():
                if any(row.name == node for row in update.nodes):
                    return True
        return False

    def updates(self, within_s: float = LOOK_S) -> Iterator[GraphUpdate]:
        """Yield what has come by then, at least one unless nothing has; return in time.

        Raises:
            UsageError: if ROS cannot be used.
        """
        deadline_s = time.monotonic() + within_s
        while (left_s := deadline_s - time.monotonic()) > 0.0:
            try:
                update = self._updates.get(timeout=left_s)
            except queue.Empty:
                return
            if update.error:
                raise UsageError(update.error)
            now_s = time.monotonic()
            self._joined_s = min(self._joined_s, now_s)
            if self._size != (size := (len(update.nodes), len(update.topics), len(update.services))):
                self._size, self._news_s = size, now_s
            yield update

    def refuse_empty(self, update: GraphUpdate) -> None:
        """Raise UsageError if nobody but Deck's own observers is in the domain."""
        from graph.findings.finding import is_deck

        if not all(is_deck(node.name) for node in update.nodes):
            return
        if self.discovery == "localhost":
            words = say(
                "no node was found in domain {domain} on this machine: start one, choose "
                "another with --domain, or look on the network with --discovery subnet",
                domain=self.domain,
            )
        else:
            words = say(
                "no node was found in domain {domain}: start one, or choose another with --domain", domain=self.domain
            )
        raise UsageError(words)


@contextmanager
def domain_view(
    asked: int | None,
    wanted: str | None = None,
    **interest: Any,  # noqa: ANN401 - what Interest has
) -> Iterator[DomainView]:
    """Observe the domain that was asked for, else that of the running robot, and leave it again.

    `interest`: the fields of `graph.data.Interest`.

    Raises:
        UsageError: if robots run in several domains.
    """
    from graph.data import Interest
    from graph.observer.observer import Observer

    _name, domain, discovery = running_domain(asked, wanted)
    keep_stdout_to_ourselves()
    observer = Observer(domain, discovery)
    view = DomainView(domain, discovery, observer)
    observer.want(Interest(period_s=LOOK_S, **interest))
    observer.start(view.take)
    try:
        yield view
    finally:
        observer.stop()


def tell_that_it_takes_time(words: str) -> None:
    """Write to standard error, if a person reads it, why there is no answer yet."""
    if sys.stderr is not None and sys.stderr.isatty():
        say_error(words)
