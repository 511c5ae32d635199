"""The messages of `drive_to_point`, in its log and in the result of the action."""

from __future__ import annotations

from text.i18n import N_

STARTED = N_("Ready to drive to a point: action {action}")
GOAL = N_("Driving to x {x:.2f}, y {y:.2f} m, to within {tolerance:.2f} m")

REACHED = N_("Arrived: the point is {distance:.2f} m away")
CANCELLED = N_("Cancelled as asked, {distance:.2f} m from the point")
REPLACED = N_("Preempted by a newer goal, {distance:.2f} m from the point")
NO_ODOMETRY = N_("Nobody publishes {topic}: the robot's position is unknown; start its base, or simulate:=auto")
STALE = N_("No {topic} for {stale_s:g} s, {distance:.2f} m from the point: the base is gone")
STANDS = N_(
    "The robot has not moved for {patience_s:g} s, {distance:.2f} m from the point: "
    "something holds it, a safety gate or an obstacle"
)
DRIVEN_TOO_FAR = N_(
    "The robot drives but does not arrive, {distance:.2f} m from the point: "
    "is the odometry right, and is nobody else steering?"
)
EMERGENCY = N_("Emergency stop, {distance:.2f} m from the point")
ENDING = N_("The node is ending, {distance:.2f} m from the point")

NO_NUMBERS = N_("Refused: x {x}, y {y}, tolerance {tolerance} are not all numbers")
TOO_FAR = N_("Refused: x {x:g}, y {y:g} m is farther away than {farthest:g} m (max_distance)")
BAD_TOLERANCE = N_("Refused: tolerance {tolerance:g} m, must be 0 or from {finest:g} to {coarsest:g} m")
HELD = N_("Refused: the emergency stop is held, release it first")
EMERGENCY_HELD = N_("EMERGENCY STOP: no goal is driven to until it is released")
RELEASED = N_("The emergency stop is released; waiting for a new goal")
