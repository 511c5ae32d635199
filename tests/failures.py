"""Which tests have failed, and the first reason of each: a plug-in of pytest for `tests.run`."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    import pytest

FAILURES = "--failures"
"""The option that names the file in which they are written down."""
_LONGEST = 200


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(FAILURES, type=Path, help="write down here which tests have failed, and why")


def pytest_configure(config: pytest.Config) -> None:
    """Record them in the process that hears of all tests."""
    if not hasattr(config, "workerinput"):
        config.pluginmanager.register(Recorder(config.getoption(FAILURES)))


class Failure(NamedTuple):
    """A test that has failed."""

    test: str
    reason: str


class Recorder:
    """Keeps the failures of a run."""

    def __init__(self, path: Path) -> None:
        """`path` is written when the run ends."""
        self._path = path
        self._reasons: dict[str, str] = {}

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Keep the first failure of each test."""
        if report.failed:
            self._reasons.setdefault(report.nodeid, _reason(report))

    def pytest_sessionfinish(self) -> None:
        self._path.write_text(json.dumps(list(self._reasons.items())), encoding="utf-8")


def read(path: Path) -> list[Failure]:
    """Return what a run has written; nothing if it did not come to that."""
    if not path.exists():
        return []
    return [Failure(*each) for each in json.loads(path.read_text(encoding="utf-8"))]


def _reason(report: pytest.TestReport) -> str:
    crash = getattr(report.longrepr, "reprcrash", None)
    # Of a process that has ended there are only the words.
    words = str(report.longrepr) if crash is None else crash.message
    first = next((line for line in words.splitlines() if line.strip()), "no reason was told")
    return f"{report.when}: {first.strip()}"[:_LONGEST]
