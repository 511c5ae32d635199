"""Fixtures for tests with real nodes and real processes."""

from __future__ import annotations

import subprocess
from typing import TYPE_CHECKING

import pytest

import launcher.client.start
from tests.conftest import take
from tests.ros import warm_supervisor
from tests.ros.observing import Watcher
from tests.ros.peer import Peer
from tests.ros.supervised import start

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from tests.domains import DomainPool

__all__ = ["start"]


@pytest.fixture(autouse=True, scope="package")
def _found_in_tenths_of_a_second(domain_pool: DomainPool) -> None:
    """Have Deck's settings hold in this process: Fast DDS reads them once, with the first node.

    Which node is the first one depends on the tests that this worker gets.
    """
    domain = take(domain_pool)
    Peer(domain).close()
    domain_pool.let_go(domain)


@pytest.fixture(autouse=True, scope="package")
def _warm_supervisors() -> Iterator[None]:
    """Have supervisors forked: most tests are about what they do, and not about how they begin."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(launcher.client.start, "subprocess", warm_supervisor)
        yield


@pytest.fixture(autouse=True)
def _cold_supervisors(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Start it as Deck does where a test is marked `cold`."""
    if request.node.get_closest_marker("cold"):
        monkeypatch.setattr(launcher.client.start, "subprocess", subprocess)


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
def model_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The user's folder for `llm.yaml`, without one yet; and a cache of the test's own."""
    for name in ("XDG_CONFIG_HOME", "XDG_CACHE_HOME"):
        monkeypatch.setenv(name, str(tmp_path))
    (tmp_path / "deck").mkdir()
    return tmp_path / "deck"
