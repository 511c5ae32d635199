"""The lesson at work."""

from __future__ import annotations

from typing import ClassVar

from tui.screens.base import DeckScreen


class LessonDeck(DeckScreen):
    """Nodes, sensors, wheels, camera, head, voice and log of the lesson."""

    tab: ClassVar[str] = "deck"
