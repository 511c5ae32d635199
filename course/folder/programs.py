"""What may run in the place of a node that runs: the learner's own files, or Deck's node."""

from __future__ import annotations

from pathlib import Path

from course.folder.folder import folder_of, own_profile
from course.lessons.catalog import course_dir, lesson_of
from course.lessons.lesson import LessonFolder, folders
from launcher.errors import LauncherError
from launcher.profile.defaults import FOLDERS_OWN
from launcher.profile.load import load_profile
from launcher.profile.model import Profile
from launcher.status import NodeStatus, SessionInfo

OF_DECK = "nodes."
"""What the name of a module of Deck's own nodes begins with."""


def programs_for(session: SessionInfo, node: NodeStatus) -> list[Path | str | None]:
    """Return what can be run in the place of what this node runs now, the likeliest first.

    A path is a file of the learner's own, a text a module of Deck, and None what the profile itself
    names. A lesson's folder is made if there is none yet.

    Raises:
        LauncherError: if the profile cannot be read any more.
        OSError: if the folder cannot be made.
    """
    profile = load_profile(session.profile, hardware=session.hardware)
    lesson = lesson_of(profile)
    spec = profile.nodes.get(node.name)
    own_at_first = spec is not None and bool(spec.file)
    if bool(node.file) != own_at_first:
        return [None]
    if node.file:
        return [*_of_deck(lesson, node.name)]
    return [*_own(lesson, profile.name, node.name)]


def _of_deck(lesson: LessonFolder | None, node: str) -> list[str]:
    spec = None if lesson is None else lesson.profile.nodes.get(node)
    run = "" if spec is None else spec.run or ""
    return [run] if run.startswith(OF_DECK) else []


def _own(lesson: LessonFolder | None, name: str, node: str) -> list[Path]:
    """Return the learner's files for a node of this name: this lesson's first, then the others'."""
    if lesson is not None and not (folder_of(lesson) / FOLDERS_OWN).is_file():
        starter = _profile_in(lesson.starter)
        if starter is not None and _file_in(starter, node):
            own_profile(lesson)
    here = course_dir() / (name if lesson is None else lesson.name)
    places = [here, *(folder for folder in folders(course_dir()) if folder != here)]
    profiles = filter(None, map(_profile_in, places))
    files = (_file_in(profile, node) for profile in profiles)
    return list(dict.fromkeys(Path(file) for file in files if file))


def _profile_in(folder: Path) -> Profile | None:
    """Return the profile of a folder; None if it has none, or one that cannot be started."""
    try:
        return load_profile(folder / FOLDERS_OWN) if (folder / FOLDERS_OWN).is_file() else None
    except (LauncherError, OSError):
        return None


def _file_in(profile: Profile, node: str) -> str:
    spec = profile.nodes.get(node)
    return "" if spec is None else spec.file
