"""The available profiles: those of the course, those in `./profiles`, and any file by its path."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from launcher.errors import LauncherError, ProfileError, ProfileNotFoundError, ProfileProblem, UsageError
from launcher.profile.defaults import FOLDERS_OWN, SHIPPED
from text.sentences import say
from text.suggestions import near

ENDINGS = (".yaml", ".yml")
LESSON = re.compile(r"0*([0-9]+[a-z]?)(?![0-9a-z])")
"""The number that a profile's name begins with: 4b in `04b-electronic-differential`."""


@dataclass(frozen=True)
class ProfileEntry:
    """One profile as an entry of a list."""

    name: str
    """File name without its suffix: `09-brain`."""
    path: Path
    """Absolute."""
    title: Mapping[str, str] = field(default_factory=dict)
    about: Mapping[str, str] = field(default_factory=dict)
    lesson: str = ""
    nodes: tuple[str, ...] = ()
    panels: tuple[str, ...] = ()
    error: str = ""
    """Why it cannot be started, one problem a line; empty if it can."""
    problems: tuple[ProfileProblem, ...] = ()
    """The same as separate problems."""


def list_profiles(paths: Iterable[Path | str] = (), *, hardware: str = "mock") -> list[ProfileEntry]:
    """Return all profiles, the lessons in their order; broken ones with their error.

    `paths`: files and folders in addition to the course's profiles and `./profiles`.
    """
    files = [*_files_of(SHIPPED), *_files_of(Path("profiles"))]
    for path in map(Path, paths):
        files += _files_of(path) if path.is_dir() else [path]
    # Path.resolve() raises for a link to itself.
    different = {os.path.realpath(path): path for path in reversed(files)}
    return [_entry(path, hardware) for path in sorted(different.values(), key=_order)]


def find_profile(name: str | Path) -> Path:
    """Return the file of a profile given by path, folder, name, lesson number or start of a name.

    Profiles in `./profiles` take precedence over those of the course.

    Raises:
        ProfileNotFoundError: with the names that may have been meant.
        UsageError: if several names begin like this.
    """
    text = str(name)
    inside = os.path.join(text, FOLDERS_OWN)  # noqa: PTH118
    if os.path.isfile(inside):  # noqa: PTH113
        return Path(inside)
    if is_path(text):
        return Path(text)
    known = {file.stem: file for folder in (SHIPPED, Path("profiles")) for file in _files_of(folder)}
    chosen = meant(text, known)
    if chosen is None:
        raise ProfileNotFoundError(text, _likely(text, known))
    return known[chosen]


def is_path(text: str) -> bool:
    """Whether this is the path of a profile rather than its name."""
    return os.sep in text or text.endswith(ENDINGS) or os.path.isfile(text)  # noqa: PTH113


def meant(text: str, known: Iterable[str]) -> str | None:
    """Return the one of these names that is meant: by itself, its number or its beginning.

    Raises UsageError if there are several.
    """
    names = list(known)
    if text in names:
        return text
    fits = fitting(text, names)
    if len(fits) > 1:
        raise UsageError(say("{name!r} matches several: {names}", name=text, names=", ".join(sorted(fits))))
    return fits[0] if fits else None


def fitting(text: str, known: Iterable[str]) -> list[str]:
    """Return the names with this lesson number, else those that begin with the text."""
    names = list(known)
    number = _number(text) if LESSON.fullmatch(text) else None
    fits = [name for name in names if _number(name) == number]
    return fits or [name for name in names if text and name.startswith(text)]


def _files_of(folder: Path) -> list[Path]:
    try:
        return sorted(path for path in folder.iterdir() if path.suffix in ENDINGS)
    except OSError:
        return []


def _likely(text: str, known: Iterable[str]) -> list[str]:
    """Return similar names, compared as a whole and word by word."""
    names = list(known)
    found = near(text, names, most=3, cutoff=0.7)
    for stem in names:
        if near(text, stem.split("-"), cutoff=0.7) and stem not in found:
            found.append(stem)
    return found


def _number(text: str) -> str:
    match = LESSON.match(text)
    return match.group(1) if match else ""


def _order(path: Path) -> tuple[int, int, str, str]:
    digits = re.match(r"[0-9]+", path.stem)
    number = int(digits.group()) if digits else 0
    return (0 if digits else 1, number, path.stem, str(path))


def _entry(path: Path, hardware: str) -> ProfileEntry:
    # Validation imports pydantic, which merely finding a file does not need.
    from launcher.profile.load import load_profile

    try:
        profile = load_profile(path, hardware=hardware)
    except LauncherError as error:
        return ProfileEntry(
            name=path.stem,
            path=path.absolute(),
            lesson=_number(path.stem),
            error=str(error),
            problems=error.problems if isinstance(error, ProfileError) else (),
        )
    return ProfileEntry(
        name=profile.name,
        path=profile.path,
        title=profile.title,
        about=profile.about,
        lesson=profile.lesson,
        nodes=tuple(profile.nodes),
        panels=profile.panels,
    )
