"""What can be picked, and requests to open something: plain data."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from launcher.profile.defaults import FOLDERS_OWN

if TYPE_CHECKING:
    from launcher.profile.catalog import ProfileEntry


class Score(NamedTuple):
    """How far the learner is with a lesson."""

    steps: int
    """Of the lesson."""
    points: int
    """To be earned."""
    passed: int = 0
    """Steps that have passed."""
    earned: int = 0


class WholeGrade(NamedTuple):
    """What `deck grade` says of a folder."""

    points: int
    most: int
    failed: Mapping[str, str]
    """The steps that have not passed, and why, in words."""
    ungraded: str = ""
    """Why it could not be graded to the end; empty if it was."""


class Task(NamedTuple):
    """What there is to do in a lesson."""

    folder: Path
    """That of the lesson."""
    score: Score | None = None
    """None until its steps have been read."""
    own: Path | None = None
    """The profile of the learner's own folder, None if there is no such folder yet."""
    left_off: bool = False
    """Whether it is the lesson that the learner did last."""


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
    task: Task | None = None
    """What there is to do in it, if it has steps."""
    error: str = ""
    """Why it cannot be started: `file:line:column: field: message`; empty if it can."""

    @classmethod
    def of(cls, entry: ProfileEntry, task: Task | None = None) -> Lesson:
        said = (entry.title, entry.about, entry.lesson, entry.nodes, entry.panels)
        return cls(entry.name, entry.path, *said, task, entry.error)


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
    wall: bool = False
    """Whether to begin with the wall."""

    @property
    def screen(self) -> str:
        """The screen to show first: for files of the learner's own, what is to be done."""
        if self.wall:
            return "wall"
        own = self.profile is not None and self.profile.name == FOLDERS_OWN
        return "lesson" if own else "deck"
