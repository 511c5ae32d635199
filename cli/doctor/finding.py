"""What the doctor says about one thing: its state, and the fix if something is wrong."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum


class Level(str, Enum):
    """How serious a finding is."""

    OK = "ok"
    WARN = "warn"
    """Something will not work, or not always."""
    FAIL = "fail"
    """Deck cannot do without."""


@dataclass(frozen=True)
class Finding:
    """One line of the doctor's report."""

    key: str
    """Stable, for programs: `ros.rclpy`."""
    level: Level
    text: str
    mend: str = ""
    """What to do, empty if nothing is to be done."""


def ok(key: str, text: str) -> Finding:
    """Say that something is well."""
    return Finding(key, Level.OK, text)


def warn(key: str, text: str, mend: str) -> Finding:
    """Say that something will not work, or not always."""
    return Finding(key, Level.WARN, text, mend)


def fail(key: str, text: str, mend: str) -> Finding:
    """Say that something is missing that Deck cannot do without."""
    return Finding(key, Level.FAIL, text, mend)
