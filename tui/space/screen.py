"""What is where: frames, the robot, its map and what its sensors see."""

from __future__ import annotations

from typing import ClassVar

from text.i18n import N_
from tui.frame.screen import DeckScreen


class SpaceScreen(DeckScreen):
    """What is where: frames, the robot, its map and what its sensors see."""

    tab: ClassVar[str] = "space"
    about: ClassVar[str] = N_("What is where: frames, the robot, its map and what its sensors see.")
