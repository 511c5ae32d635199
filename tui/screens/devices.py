"""Every driver, what it is connected to, and what goes over its port."""

from __future__ import annotations

from typing import ClassVar

from tui.screens.base import DeckScreen


class DevicesScreen(DeckScreen):
    """Drivers above, frames of the chosen one below."""

    tab: ClassVar[str] = "devices"
