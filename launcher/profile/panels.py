"""The panels that a profile may list: part of the file format, and what is to be known of them without the screen.

The panel `sonar` itself is the class `SonarPanel` in `tui.panels.sonar`. The schema of profiles, the list of lessons,
and which panels stand beside the nodes of others are made from this table, which the robot announces.
"""

from __future__ import annotations

from collections.abc import Set as AbstractSet
from typing import TYPE_CHECKING, Literal

from text.robot import robot

PANELS = robot().panels

if TYPE_CHECKING:
    Panel = str
else:
    # No robot, no panels; and a Literal cannot be empty.
    Panel = Literal[tuple(PANELS)] if PANELS else str


def panels_for(topics: AbstractSet[str]) -> tuple[str, ...]:
    """Return the panels that these topics can fill."""
    return tuple(name for name, entry in PANELS.items() if topics & set(entry.needs))
