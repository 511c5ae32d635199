"""The names of the robot's joints, as `sensor_msgs/JointState` carries them."""

from __future__ import annotations

REAR_LEFT_WHEEL = "rear_left_wheel_joint"
REAR_RIGHT_WHEEL = "rear_right_wheel_joint"
STEERING = "steering_joint"
HEAD_PAN = "pan_joint"
HEAD_TILT = "tilt_joint"

DRIVE_JOINTS = (REAR_LEFT_WHEEL, REAR_RIGHT_WHEEL, STEERING)
"""In the order of /wheel_commands and /joint_states."""
HEAD_JOINTS = (HEAD_PAN, HEAD_TILT)
"""In the order of /head_state."""
