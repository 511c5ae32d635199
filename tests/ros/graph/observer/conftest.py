"""A node that does what it is told, and an observer, for all tests of a module."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from graph.data import Interest
from graph.observer.requests import ForgetGoal, StopPublishingAll
from tests.ros.observing import Peer, Watcher
from tests.ros.peer import Peer as InProcess
from tests.waiting import wait_until


@pytest.fixture(scope="module")
def talker(module_domain: int) -> Iterator[Peer]:
    peer = Peer("talker", module_domain)
    yield peer
    peer.close()


@pytest.fixture
def watcher(module_watcher: Watcher) -> Iterator[Watcher]:
    """The observer of all tests of the module, which wants nothing yet."""
    module_watcher.samples.clear()
    yield module_watcher
    observer = module_watcher.observer
    observer.want(Interest())
    observer.ask(StopPublishingAll())
    for each in module_watcher.update.goals:
        observer.ask(ForgetGoal(each.number))
    wait_until(
        lambda: not (module_watcher.update.goals or module_watcher.update.publications), "nothing is under way"
    )


@pytest.fixture
def peer(module_domain: int) -> Iterator[InProcess]:
    """Somebody of this test alone, in the domain of the module."""
    with InProcess(module_domain) as peer:
        yield peer
