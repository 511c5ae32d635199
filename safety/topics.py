"""The topics of the stop, of the gate, and of the keys that drive, whichever robot it is."""

from __future__ import annotations

DRIVE_TELEOP = "/drive_teleop"
"""Where a person's keys drive."""
EMERGENCY_STATE = "/emergency_stop_state"
EMERGENCY_STOP = "/emergency_stop"
"""Where people and screens say that the robot has to stand still."""
SAFETY_STATE = "/safety_state"
