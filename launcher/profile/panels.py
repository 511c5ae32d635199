"""The panels that a profile may list: part of the file format, and what is to be known of them without the screen.

The panel `sonar` itself is the class `SonarPanel` in `tui.panels.sonar`. The schema of profiles, the list of lessons,
and which panels stand beside the nodes of others are made from this table.
"""

from __future__ import annotations

from collections.abc import Set as AbstractSet
from typing import TYPE_CHECKING, Literal, NamedTuple

from robot import topics as of
from text.i18n import N_


class PanelEntry(NamedTuple):
    """What a panel is called, and its topics."""

    title: str
    """The name in the list of lessons, to be translated."""
    needs: tuple[str, ...] = ()
    """Topics of others: if one of them exists, the panel has something to show."""


PANELS: dict[str, PanelEntry] = {
    "sonar": PanelEntry(N_("sonar"), (of.SONAR_FRONT, of.SONAR_REAR)),
    "wheels": PanelEntry(N_("wheels"), (of.WHEEL_COMMANDS, of.JOINT_STATES)),
    "map": PanelEntry(N_("map"), (of.ODOMETRY, of.MAP)),
    "camera": PanelEntry(N_("camera"), (of.CAMERA,)),
    "head": PanelEntry(N_("head"), (of.HEAD_STATE,)),
    "voice": PanelEntry(N_("voice"), (of.MICROPHONE, of.SPEAKER)),
    "brain": PanelEntry(N_("brain"), (of.BRAIN_STATE,)),
    "composer": PanelEntry(N_("composer")),
}
"""In the order in which they are shown."""

if TYPE_CHECKING:
    Panel = str
else:
    Panel = Literal[tuple(PANELS)]


def panels_for(topics: AbstractSet[str]) -> tuple[str, ...]:
    """Return the panels that these topics can fill."""
    return tuple(name for name, entry in PANELS.items() if topics & set(entry.needs))
