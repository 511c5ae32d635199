"""One result of the doctor: a state, and the fix if something is wrong."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum


class Level(str, Enum):
    """How serious a finding is."""

    OK = "ok"
    WARN = "warn"
    """Something will not work, or not reliably."""
    FAIL = "fail"
    """Something essential is missing."""


@dataclass(frozen=True)
class Finding:
    """One line of the doctor's report."""

    key: str
    """A stable key for programs: `ros.rclpy`."""
    level: Level
    text: str
    fix: str = ""
    """What to do about it, empty if there is nothing to fix."""

    def for_programs(self) -> dict[str, str]:
        """Return it as it is written with `--json`."""
        return {"key": self.key, "level": self.level, "text": self.text, "mend": self.fix}


def ok(key: str, text: str) -> Finding:
    return Finding(key, Level.OK, text)


def warn(key: str, text: str, fix: str) -> Finding:
    return Finding(key, Level.WARN, text, fix)


def fail(key: str, text: str, fix: str) -> Finding:
    return Finding(key, Level.FAIL, text, fix)


def either(holds: bool, key: str, text: str, fix: str) -> Finding:
    """Report something that is all right if it holds, and else will not work, or not reliably."""
    return ok(key, text) if holds else warn(key, text, fix)
