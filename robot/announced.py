"""What this robot says of itself to the rooms that know none, see `text.robot`."""

from __future__ import annotations

from text.robot import Robot

ROBOT = Robot(
    roles={
        "nodes.ai_brain": ("drives", "brain"),
        "nodes.ai_driver": ("drives", "words"),
        "nodes.audio": ("driver",),
        "nodes.camera": ("driver",),
        "nodes.chassis": ("drives", "driver"),
        "nodes.drive_to_point": ("drives",),
        "nodes.electronic_differential": ("drives", "wheels"),
        # Without a port it is no driver: the profile `robot` says that it has one.
        "nodes.head_controller": ("head",),
        "nodes.llm_parser": ("drives", "brain"),
        "nodes.mock_robot": ("simulator",),
        "nodes.realtime_brain": ("brain",),
        "nodes.safety_stop": ("gate",),
        "nodes.tof_sonar": ("driver",),
    }
)
