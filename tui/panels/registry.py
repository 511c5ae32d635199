"""The panels by their names in profiles; imported when a session that has them is opened."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, NamedTuple

from robot.topics import (
    BRAIN_STATE,
    CAMERA,
    HEAD_STATE,
    JOINT_STATES,
    MAP,
    MICROPHONE,
    ODOMETRY,
    SONAR_FRONT,
    SONAR_REAR,
    SPEAKER,
    WHEEL_COMMANDS,
)
from text.i18n import N_

if TYPE_CHECKING:
    from collections.abc import Set as AbstractSet

    from launcher.profile.model import Panel as PanelName
    from tui.panels.panel import Panel


class PanelEntry(NamedTuple):
    """Where to find a panel, and its topics."""

    title: str
    """The name in the picker, to be translated."""
    module: str
    class_name: str
    needs: tuple[str, ...] = ()
    """Topics of others: if one of them exists, the panel has something to show."""


PANELS: dict[PanelName, PanelEntry] = {
    "sonar": PanelEntry(N_("sonar"), "tui.panels.sonar.panel", "SonarPanel", (SONAR_FRONT, SONAR_REAR)),
    "wheels": PanelEntry(N_("wheels"), "tui.panels.wheels.panel", "WheelsPanel", (WHEEL_COMMANDS, JOINT_STATES)),
    "map": PanelEntry(N_("map"), "tui.panels.map.panel", "MapPanel", (ODOMETRY, MAP)),
    "camera": PanelEntry(N_("camera"), "tui.panels.camera", "CameraPanel", (CAMERA,)),
    "head": PanelEntry(N_("head"), "tui.panels.head.panel", "HeadPanel", (HEAD_STATE,)),
    "voice": PanelEntry(N_("voice"), "tui.panels.voice.panel", "VoicePanel", (MICROPHONE, SPEAKER)),
    "brain": PanelEntry(N_("brain"), "tui.panels.brain", "BrainPanel", (BRAIN_STATE,)),
    "composer": PanelEntry(N_("composer"), "tui.panels.llm", "LlmPanel"),
}
"""The panels that a profile may name in `panels`, in the order in which they are shown."""


def entry_of(name: str) -> PanelEntry | None:
    """Return the entry of a panel, None for a name that this version does not know."""
    return PANELS.get(name)  # type: ignore[call-overload, no-any-return]


def make_panel(name: str) -> Panel:
    """Make one of `PANELS`."""
    entry = entry_of(name)
    if entry is None:
        raise KeyError(name)
    panel: Panel = getattr(import_module(entry.module), entry.class_name)()
    return panel


def panels_for(topics: AbstractSet[str]) -> tuple[str, ...]:
    """Return the panels that these topics can fill."""
    return tuple(name for name, entry in PANELS.items() if topics & set(entry.needs))
