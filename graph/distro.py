"""Which ROS 2 this is: what differs between them for Deck is asked here."""

from __future__ import annotations

import os
from functools import lru_cache
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from importlib.metadata import Distribution

TESTED = ("jazzy", "kilted")


def wheel_of(distro: str) -> Distribution | None:
    """Return rclpy of this ROS as PyPI has it, None if that is not installed."""
    from importlib import metadata

    try:
        return metadata.distribution(f"ros-{distro}-rclpy")
    except metadata.PackageNotFoundError:
        return None


@lru_cache(maxsize=1)
def distro() -> str:
    """Return the name of the ROS that was sourced, else of the one from PyPI."""
    named = os.environ.get("ROS_DISTRO")
    return named or next(filter(wheel_of, TESTED), TESTED[0])
