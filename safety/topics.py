"""The topics of the stop and of the gate, whichever robot it is."""

from __future__ import annotations

EMERGENCY_STATE = "/emergency_stop_state"
EMERGENCY_STOP = "/emergency_stop"
"""Where people and screens say that the robot has to stand still."""
SAFETY_STATE = "/safety_state"
