"""Which ROS 2 is set up: Jazzy, or with `make setup ROS=kilted` Kilted, from PyPI like everything else."""

from __future__ import annotations

import os
import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

EXTRAS = {"jazzy": "ros", "kilted": "ros-kilted"}
"""The extra of pyproject.toml that has each; locked/ has files for each, too."""
FIRST = "jazzy"
GONE = "python-cmake-module"
"""A package to build message types with that is not there after Jazzy."""
MARK = ".ros"
"""In an environment, which one it has; scripts/sound.sh reads it, too."""


class UnknownDistroError(Exception):
    """ROS is set to what is none of them; str() is that."""


def wanted_distro(environment: Path | None = None) -> str:
    """Return the one that is asked for, else the one that the environment has.

    Raises:
        UnknownDistroError: if there is none of this name.
    """
    mark = None if environment is None else environment / MARK
    distro = os.environ.get("ROS") or (mark.read_text().strip() if mark and mark.exists() else FIRST)
    if distro not in EXTRAS:
        raise UnknownDistroError(distro)
    return distro


def for_distro(text: str, distro: str) -> str:
    """Return requirements on packages of Jazzy as those of another ROS, of any version; each has a line."""
    if distro == FIRST:
        return text
    text = re.sub(rf".*ros-jazzy-{GONE}.*\n?", "", text)
    return re.sub(r"ros-jazzy-([a-z-]+)[^\"'\n]*", rf"ros-{distro}-\1", text)
