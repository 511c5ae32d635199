"""The panels by the names that profiles give them; imported when a session that has them opens."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tui.panels.panel import Panel

PANELS = {
    "sonar": ("tui.panels.sonar.panel", "SonarFeed"),
    "wheels": ("tui.panels.wheels.panel", "WheelsFeed"),
    "map": ("tui.panels.map.panel", "MapFeed"),
    "camera": ("tui.panels.camera", "CameraFeed"),
    "head": ("tui.panels.head.panel", "HeadFeed"),
    "voice": ("tui.panels.voice.panel", "VoiceFeed"),
    "composer": ("tui.panels.llm", "LlmFeed"),
}
"""What a profile's `panels` may name."""


def make_panel(name: str) -> Panel:
    """Make one of `PANELS`."""
    module, made = PANELS[name]
    panel: Panel = getattr(import_module(module), made)()
    return panel
