"""The defaults of a profile, for code that does not import the profile model."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

READY_WITHIN_S = 10.0
"""How long a node may take to become ready."""
FOLDERS_OWN = "lesson.yaml"
"""The profile that is meant by the folder it is in, and has that folder's name."""


def name_of(profile: Path) -> str:
    """Return what a profile is called."""
    return profile.parent.name if profile.name == FOLDERS_OWN else profile.stem
