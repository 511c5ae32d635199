"""What can be picked, and requests to open something: plain data."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple


class Lesson(NamedTuple):
    """One profile in the picker."""

    name: str
    """File name without its ending: `09-brain`."""
    path: Path
    title: Mapping[str, str]
    """Language code to title."""
    about: Mapping[str, str] = {}
    """Language code to a few sentences."""
    lesson: str = ""
    nodes: tuple[str, ...] = ()
    panels: tuple[str, ...] = ()
    error: str = ""
    """Why it cannot be started: `file:line:column: field: message`; empty if it can."""


class ReplayRequest(NamedTuple):
    """A recording to be played, and how."""

    bag: Path
    rate: float = 1.0
    loop: bool = False
    start_s: float = 0.0


class WatchRequest(NamedTuple):
    """A domain in which others have started nodes."""

    domain: int
    discovery: str = "localhost"
    """`localhost` for this machine only, `subnet` for the network too."""


class OpenRequest(NamedTuple):
    """What to open: a profile to be started, or something that already exists."""

    profile: Path | None = None
    attach: str | None = None
    hardware: str = "mock"
    overrides: tuple[str, ...] = ()
    domain: int | None = None
    replay: ReplayRequest | None = None
    watch: WatchRequest | None = None
    beside: bool = False
    """Whether it may share its domain with other sessions."""
