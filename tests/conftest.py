"""What every test gets: an environment of its own, and a ROS domain nobody else uses."""

from __future__ import annotations

import contextlib
import faulthandler
import gc
import os
import shutil
import signal
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from unittest import mock

import psutil
import pytest
import pytest_timeout
from hypothesis import HealthCheck, settings

from graph.ros import FAST_DDS_VARIABLES, LOCALHOST_ONLY, ONLY_THESE, PEERS, TRANSPORTS, announcing
from tests.distribution import ALONE, EachTestOnce
from tests.domains import DomainPool
from tests.machine import PLAIN, left_out, needs_of
from tests.slowness import keep_measured, patient
from tests.unit.scripts_of_setup import load

# A loaded machine is no failure of the code. Each run takes other examples: half as many as usual
# are enough of them. Where a change is judged they are the same ones for all.
settings.register_profile(
    "deck",
    deadline=None,
    max_examples=50,
    derandomize="CI" in os.environ,
    suppress_health_check=[HealthCheck.too_slow],
)
settings.load_profile("deck")

# As `deck` has it: what numpy's idle threads spin away at each start is some other test's time.
os.environ.setdefault("OPENBLAS_THREAD_TIMEOUT", "4")

# Whoever runs this by `&` in a script ignores it, and so would all that is started here.
signal.signal(signal.SIGINT, signal.default_int_handler)

TESTS = Path(__file__).resolve().parent
STATE_DIR = "DECK_STATE_DIR"
_STATE = "deck-test-state-"

MIDDLEWARE = (*FAST_DDS_VARIABLES, ONLY_THESE, PEERS, LOCALHOST_ONLY, TRANSPORTS)
"""Whom a developer's own programs find, and who finds them."""


def _clear_states() -> None:
    """Remove what runs of this user have left that were killed."""
    for folder in Path(tempfile.gettempdir()).glob(f"{_STATE}*-*"):
        pid = folder.name.removeprefix(_STATE).partition("-")[0]
        with contextlib.suppress(OSError):
            ours = pid.isdigit() and folder.lstat().st_uid == os.geteuid()
            if ours and not psutil.pid_exists(int(pid)):
                shutil.rmtree(folder)


_clear_states()
load("catalogues").compile_stale()
os.environ[STATE_DIR] = tempfile.mkdtemp(prefix=f"{_STATE}{os.getpid()}-")
"""Set for the whole run: nodes that a module shares, started anew by a test, remember alike."""


LEFT_OUT = "left_out"
"""Under this a process of the run tells the first one what the tests need that it has left out."""
LEFT = pytest.StashKey[list[tuple[str, ...]]]()

REAL_STDERR = pytest.StashKey[int]()
AFTER_TIMEOUT_S = 60.0
"""How long after its time a test may still be there, to fail and to clean up."""


def pytest_addoption(parser: pytest.Parser) -> None:
    """The option of `make test`."""
    parser.addoption(PLAIN, action="store_true", help="leave out what `make test-all` adds")


def pytest_configure(config: pytest.Config) -> None:
    """Keep where a dying process of the run can write: nothing is caught yet."""
    config.stash[REAL_STDERR] = os.dup(2)
    if not hasattr(config, "workerinput"):
        keep_measured(Path(os.environ[STATE_DIR], "slowness"))


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item: pytest.Item) -> None:
    _end_if_it_hangs(item)


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_teardown(item: pytest.Item) -> None:
    """Bound the clean-up as well: after a failure pytest has called off the former bound."""
    _end_if_it_hangs(item)


def pytest_runtest_logfinish() -> None:
    faulthandler.cancel_dump_traceback_later()


def _end_if_it_hangs(item: pytest.Item) -> None:
    """End this process if the time-out of the test does not, and say where it stands.

    pytest-timeout needs Python's lock, which a call into ROS that never returns may hold. The run
    goes on in another process; the test has failed.
    """
    mark = item.get_closest_marker("timeout")
    timeout_s = float(mark.args[0] if mark else item.config.getini("timeout"))
    error = item.config.stash[REAL_STDERR]
    faulthandler.dump_traceback_later(patient(timeout_s) + AFTER_TIMEOUT_S, file=error, exit=True)


@pytest.hookimpl(tryfirst=True, optionalhook=True)
def pytest_timeout_set_timer(item: pytest.Item, settings: Any) -> Any:
    """Give a test more time on a slow machine."""
    settings = settings._replace(timeout=patient(settings.timeout))
    return pytest_timeout.pytest_timeout_set_timer(item, settings)


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave out what a plain machine cannot run, if told so; put the others in order."""
    _order(items)
    if config.getoption(PLAIN):
        left = [item for item in items if needs_of(item)]
        config.stash[LEFT] = [needs_of(item) for item in left]
        if hasattr(config, "workeroutput"):
            config.workeroutput[LEFT_OUT] = config.stash[LEFT]
        config.hook.pytest_deselected(items=left)
        items[:] = [item for item in items if not needs_of(item)]


def _order(items: list[pytest.Item]) -> None:
    """Spread the files of each folder over the run: some wait for processes while others compute.

    Those that are run alone come last.
    """
    folders: dict[tuple[str, ...], list[Path]] = {}
    for path in dict.fromkeys(item.path for item in items):
        folders.setdefault(path.parent.relative_to(TESTS).parts[:2], []).append(path)
    place: dict[Path, float] = {
        path: (number + 0.5) / len(paths) for paths in folders.values() for number, path in enumerate(paths)
    }
    place |= {TESTS.parent / name: number for number, name in enumerate(ALONE, 1)}
    items.sort(key=lambda item: place[item.path])


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> EachTestOnce | None:
    """Hand out the tests so that a run outlives the death of one of its processes."""
    return EachTestOnce(config, log) if config.getoption("dist") == "loadfile" else None


def pytest_collection_finish() -> None:
    """Look through less for garbage: what is imported by now stays, and a screen makes much."""
    gc.collect()
    gc.freeze()
    gc.set_threshold(20_000, 20, 20)


@pytest.hookimpl(optionalhook=True)
def pytest_testnodedown(node: Any) -> None:
    """Keep what a process of the run has left out: each one collects all tests."""
    told = getattr(node, "workeroutput", {}).get(LEFT_OUT, ())
    if told:
        node.config.stash[LEFT] = [tuple(names) for names in told]


def pytest_unconfigure(config: pytest.Config) -> None:
    """Leave nothing behind, and say last what was left out."""
    left: list[tuple[str, ...]] = config.stash.get(LEFT, [])
    words = left_out(left)
    if words and not hasattr(config, "workeroutput"):
        sys.stdout.write(f"{words}\n")
    shutil.rmtree(os.environ[STATE_DIR], ignore_errors=True)


@pytest.fixture(autouse=True)
def _unchanged_environment() -> Iterator[None]:
    """Take back what a test, or the program in it, has set for good."""
    with mock.patch.dict(os.environ):
        yield


@pytest.fixture(autouse=True)
def _own_environment(_unchanged_environment: None, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Keep a developer's own settings, run directory and logs out of the tests."""
    for name in ("NO_COLOR", "LANGUAGE", "LC_ALL", "LC_MESSAGES", "COLORTERM", *MIDDLEWARE):
        monkeypatch.delenv(name, raising=False)
    for name in [name for name in os.environ if name.startswith("DECK_") and name != STATE_DIR]:
        monkeypatch.delenv(name)
    monkeypatch.setenv("LANG", "C.UTF-8")
    monkeypatch.setenv("DECK_RUN_DIR", str(tmp_path / "run"))
    monkeypatch.setenv("DECK_LOG_DIR", str(tmp_path / "logs"))
    monkeypatch.setenv("DECK_RECORDINGS_DIR", str(tmp_path / "recordings"))
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "config"))
    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path / "ros-logs"))
    for name, value in announcing("localhost").items():
        if value is not None:
            monkeypatch.setenv(name, value)


@pytest.fixture(scope="session")
def domain_pool() -> Iterator[DomainPool]:
    folder = Path("/tmp") / f"deck-test-domains-{os.getuid()}"
    pool = DomainPool(folder, machine="deck-test-domain")
    yield pool
    pool.let_go()


def take(pool: DomainPool) -> int:
    """Return a free domain, without the emergency stop that an earlier test has left there."""
    domain = pool.take()
    (Path(os.environ[STATE_DIR]) / "stops" / str(domain)).unlink(missing_ok=True)
    return domain


@pytest.fixture
def ros_domain(domain_pool: DomainPool, monkeypatch: pytest.MonkeyPatch) -> Iterator[int]:
    """A ROS domain of this test's own, set in the environment."""
    domain = take(domain_pool)
    monkeypatch.setenv("ROS_DOMAIN_ID", str(domain))
    yield domain
    domain_pool.let_go(domain)


@pytest.fixture
def other_domain(domain_pool: DomainPool) -> Iterator[int]:
    """Another ROS domain of this test's own."""
    domain = take(domain_pool)
    yield domain
    domain_pool.let_go(domain)


@pytest.fixture(scope="module")
def module_domain(domain_pool: DomainPool) -> Iterator[int]:
    """A ROS domain for fixtures that live as long as a test module."""
    domain = take(domain_pool)
    yield domain
    domain_pool.let_go(domain)
