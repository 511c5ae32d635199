"""What every test gets: an environment of its own, and a ROS domain nobody else uses."""

from __future__ import annotations

import fcntl
import os
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

# A loaded machine is no failure of the code.
settings.register_profile("deck", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("deck")

DOMAINS = range(1, 102)
"""Linux's ephemeral ports leave these domains free (ROS 2 documentation, "The ROS_DOMAIN_ID")."""


@pytest.fixture(autouse=True)
def _own_environment(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Keep a developer's own settings, run directory and logs out of the tests."""
    for name in ("NO_COLOR", "LANGUAGE", "LC_ALL", "LC_MESSAGES", "COLORTERM"):
        monkeypatch.delenv(name, raising=False)
    for name in [name for name in os.environ if name.startswith("DECK_")]:
        monkeypatch.delenv(name)
    monkeypatch.setenv("LANG", "C.UTF-8")
    monkeypatch.setenv("DECK_RUN_DIR", str(tmp_path / "run"))
    monkeypatch.setenv("DECK_LOG_DIR", str(tmp_path / "logs"))
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "config"))
    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path / "ros-logs"))
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")


@pytest.fixture(scope="session")
def domain_pool() -> Iterator[Callable[[], int]]:
    """Hand out ROS domains that no other test run on this machine holds, by file locks."""
    folder = Path("/tmp") / f"deck-test-domains-{os.getuid()}"
    folder.mkdir(exist_ok=True)
    held: list[int] = []

    def take() -> int:
        for domain in DOMAINS:
            lock = os.open(folder / str(domain), os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600)
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                os.close(lock)
                continue
            held.append(lock)
            return domain
        raise RuntimeError("every ROS domain from 1 to 101 is held by a test")

    yield take
    for lock in held:
        os.close(lock)


@pytest.fixture
def ros_domain(domain_pool: Callable[[], int], monkeypatch: pytest.MonkeyPatch) -> int:
    """A ROS domain of this test's own, set in the environment."""
    domain = domain_pool()
    monkeypatch.setenv("ROS_DOMAIN_ID", str(domain))
    return domain


@pytest.fixture(scope="module")
def module_domain(domain_pool: Callable[[], int]) -> int:
    """A ROS domain for fixtures that live as long as a test module."""
    return domain_pool()
