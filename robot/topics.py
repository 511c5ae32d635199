"""The names of the robot's topics and services, shared by nodes and screens.

Each name is defined only here. ROS's own names (/rosout, /clock) are not the robot's.
"""

from __future__ import annotations

from text import ros_names

AI_COMMAND = "/ai_command"
AUDIO_LEVEL = "/audio/level"
BATTERY = "/battery"
BRAIN_STATE = "/brain_state"
CAMERA = "/camera/color/image_raw"
DIAGNOSTICS = ros_names.DIAGNOSTICS
DRIVE = "/drive"
DRIVE_ACTION = "/drive_action"
DRIVE_SAFE = "/drive_safe"
DRIVE_TELEOP = "/drive_teleop"
DRIVE_TO_POINT = "drive_to_point"
"""An action, relative to the namespace of its node."""
GOAL_POSE = ros_names.GOAL_POSE
HEAD_SERVICE = "set_head_position"
"""Relative to the namespace of its node."""
HEAD_STATE = "/head_state"
HEARD = "/audio/heard"
"""Words that were recognised, std_msgs/String."""
JOINT_STATES = "/joint_states"
LLM_RAW_JSON = "/llm_raw_json"
LLM_RESULT = "/llm_result"
MAP = "/map"
MICROPHONE = "/audio/mic_raw"
MOCK_MOTORS = "/mock/motors"
MOCK_POSE = "/mock/pose"
ODOMETRY = "/odom"
ROBOT_DESCRIPTION = ros_names.ROBOT_DESCRIPTION
SAY = "/say"
"""Words to be spoken, std_msgs/String; empty: be quiet at once."""
SONAR_FRONT = "/sensor/sonar_front"
SONAR_REAR = "/sensor/sonar_rear"
SONAR_FRAMES = {SONAR_FRONT: "sonar_front_link", SONAR_REAR: "sonar_rear_link"}
"""A bare number has no header: the frames in which the sonars measure are those of lesson 6."""
SPEAKER = "/audio/speaker_raw"
TF = ros_names.TF
TF_STATIC = ros_names.TF_STATIC
VLM_DESCRIPTION = "/vlm/description"
VLM_DETECTIONS = "/vlm/detections"
WHEEL_COMMANDS = "/wheel_commands"

COMMAND_SOURCES = (DRIVE_TELEOP, DRIVE_ACTION, DRIVE)
"""Commands for the gate, by rank: a person's keys, a drive to a point, words and the model."""
