"""The topics and services of the robot by name: nodes and screens meet on them.

A name stands here once. What ROS itself names (/rosout, /clock) is not the robot's.
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
"""Of commands for the gate: a person's keys, a drive to a point, words and the model; by rank."""
