"""Fixtures for tests with real nodes and real processes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.ros.observing import Watcher
from tests.ros.peer import Peer
from tests.ros.supervised import start
from tests.unfinished_shared_memory import unfinished

if TYPE_CHECKING:
    from collections.abc import Iterator

__all__ = ["start", "unfinished"]


@pytest.fixture
def peer(ros_domain: int) -> Iterator[Peer]:
    """Somebody who hears and speaks in the test's own domain."""
    with Peer(ros_domain) as peer:
        yield peer


@pytest.fixture
def watcher(ros_domain: int) -> Iterator[Watcher]:
    """An observer of the test's own domain, and what it has told."""
    watcher = Watcher(ros_domain)
    yield watcher
    watcher.close()
