"""Where profiles are and what they are called, for code that does not import their model."""

from __future__ import annotations

from pathlib import Path

SHIPPED = Path(__file__).resolve().parents[2] / "profiles"
"""The profiles of the course."""
FOLDERS_OWN = "lesson.yaml"
"""The profile that is meant by the folder it is in, and has that folder's name."""


def name_of(profile: Path) -> str:
    """Return what a profile is called."""
    return profile.parent.name if profile.name == FOLDERS_OWN else profile.stem


def shown(path: Path) -> str:
    """Return the path for messages: relative if it is below the current folder."""
    absolute = path.absolute()
    try:
        return str(absolute.relative_to(Path.cwd()))
    except (ValueError, OSError):
        return str(absolute)
