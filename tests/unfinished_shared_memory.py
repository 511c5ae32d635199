"""What Fast DDS leaves in shared memory if its process is killed at the wrong moment."""

from __future__ import annotations

import itertools
import os
import time
from typing import TYPE_CHECKING

import pytest

from launcher.processes.shared_memory import SHARED_MEMORY

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from pathlib import Path

UNFINISHED = b"\1".ljust(52_400, b"\0")
"""As large as Fast DDS makes it; the first word is boost.interprocess's `initializing`."""
PARTICIPANTS = 4


@pytest.fixture
def unfinished(ros_domain: int) -> Iterator[list[Path]]:
    """The ports of the test's own domain, as they are while Fast DDS makes them.

    The numbers are those of RTPS 2.5, section 9.6.2.3, for the unicast of users.
    """
    first = 7411 + 250 * ros_domain
    every = (SHARED_MEMORY / f"fastrtps_port{port}" for port in range(first, first + 200, 2))
    # What another user's node has left is not to be written to; a node goes on to the next one.
    paths = list(itertools.islice(itertools.filterfalse(_is_anothers, every), PARTICIPANTS))
    for path in paths:
        path.write_bytes(UNFINISHED)
    yield paths
    for path in paths:
        path.unlink(missing_ok=True)
        path.with_name(f"{path.name}_el").unlink(missing_ok=True)


def _is_anothers(path: Path) -> bool:
    return path.exists() and path.stat().st_uid != os.geteuid()


def make_old(paths: Iterable[Path], age_s: float = 60.0) -> None:
    """Let files seem to have been written so long ago."""
    then_s = time.time() - age_s
    for path in paths:
        os.utime(path, (then_s, then_s))


def is_unfinished(path: Path) -> bool:
    return path.exists() and path.read_bytes() == UNFINISHED
