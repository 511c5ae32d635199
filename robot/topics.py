"""The names of the robot's topics and services, shared by nodes and screens.

Each name is defined only here. ROS's own names (/rosout, /clock) are not the robot's.
"""

from __future__ import annotations

AI_COMMAND = "/ai_command"
AUDIO_LEVEL = "/audio/level"
BATTERY = "/battery"
CAMERA = "/camera/color/image_raw"
DIAGNOSTICS = "/diagnostics"
DRIVE = "/drive"
DRIVE_ACTION = "/drive_action"
DRIVE_SAFE = "/drive_safe"
DRIVE_TELEOP = "/drive_teleop"
DRIVE_TO_POINT = "drive_to_point"
"""An action, relative to the namespace of its node."""
EMERGENCY_STATE = "/emergency_stop_state"
EMERGENCY_STOP = "/emergency_stop"
GOAL_POSE = "/goal_pose"
HEAD_SERVICE = "set_head_position"
"""Relative to the namespace of its node."""
HEAD_STATE = "/head_state"
JOINT_STATES = "/joint_states"
LLM_RAW_JSON = "/llm_raw_json"
LLM_RESULT = "/llm_result"
MAP = "/map"
MICROPHONE = "/audio/mic_raw"
MOCK_MOTORS = "/mock/motors"
MOCK_POSE = "/mock/pose"
ODOMETRY = "/odom"
SAFETY_STATE = "/safety_state"
SONAR_FRONT = "/sensor/sonar_front"
SONAR_REAR = "/sensor/sonar_rear"
SPEAKER = "/audio/speaker_raw"
TF = "/tf"
TF_STATIC = "/tf_static"
WHEEL_COMMANDS = "/wheel_commands"

COMMAND_SOURCES = (DRIVE_TELEOP, DRIVE_ACTION, DRIVE)
"""Commands for the gate, by rank: a person's keys, a drive to a point, words and the model."""
