"""Fixtures for tests with real nodes and real processes."""

from __future__ import annotations

import os
import time
from typing import TYPE_CHECKING

import pytest

from launcher.process_shm import SHARED_MEMORY
from tests.ros.observing import Watcher
from tests.ros.peer import Peer
from tests.ros.supervised import start

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from pathlib import Path

__all__ = ["start"]

PORT_BYTES = 52_400
"""As large as Fast DDS makes it."""
PARTICIPANTS = 4


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


@pytest.fixture
def half_made(ros_domain: int) -> Iterator[list[Path]]:
    """The ports of the test's own domain, as they are while Fast DDS makes them.

    The numbers are those of RTPS 2.5, section 9.6.2.3, for the unicast of users.
    """
    first = 7411 + 250 * ros_domain
    paths = [SHARED_MEMORY / f"fastrtps_port{first + 2 * at}" for at in range(PARTICIPANTS)]
    for path in paths:
        path.write_bytes(b"\1".ljust(PORT_BYTES, b"\0"))
    yield paths
    for path in paths:
        path.unlink(missing_ok=True)
        path.with_name(f"{path.name}_el").unlink(missing_ok=True)


def make_old(paths: Iterable[Path]) -> None:
    """Let files seem to have been written a minute ago."""
    then_s = time.time() - 60.0
    for path in paths:
        os.utime(path, (then_s, then_s))
