"""Which panels have something to show, by the topics that are there."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Set as AbstractSet

NEEDS = {
    "sonar": {"/sensor/sonar_front", "/sensor/sonar_rear"},
    "wheels": {"/wheel_commands", "/joint_states"},
    "map": {"/odom", "/map"},
    "camera": {"/camera/color/image_raw"},
    "head": {"/head_state"},
    "voice": {"/audio/mic_raw", "/audio/speaker_raw"},
}
"""Panel to the topics of which it needs one."""


def panels_for(topics: AbstractSet[str]) -> tuple[str, ...]:
    """Return the panels that these topics can fill, in the order of lesson 9."""
    return tuple(panel for panel, needed in NEEDS.items() if needed & topics)
