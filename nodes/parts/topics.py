"""Names and qualities of service of the topics that nodes meet on."""

from __future__ import annotations

from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

AI_COMMAND = "/ai_command"
AUDIO_LEVEL = "/audio/level"
CAMERA = "/camera/color/image_raw"
DRIVE = "/drive"
DRIVE_ACTION = "/drive_action"
DRIVE_SAFE = "/drive_safe"
DRIVE_TELEOP = "/drive_teleop"
DRIVE_TO_POINT = "drive_to_point"
EMERGENCY_STATE = "/emergency_stop_state"
EMERGENCY_STOP = "/emergency_stop"
GOAL_POSE = "/goal_pose"
HEAD_SERVICE = "set_head_position"
HEAD_STATE = "/head_state"
LLM_RAW_JSON = "/llm_raw_json"
LLM_RESULT = "/llm_result"
MAP = "/map"
MICROPHONE = "/audio/mic_raw"
MOCK_POSE = "/mock/pose"
ODOMETRY = "/odom"
SAFETY_STATE = "/safety_state"
SONAR_FRONT = "/sensor/sonar_front"
SPEAKER = "/audio/speaker_raw"
TF = "/tf"
TF_STATIC = "/tf_static"
WHEEL_COMMANDS = "/wheel_commands"

SOURCES = (DRIVE_TELEOP, DRIVE_ACTION, DRIVE)
"""Of commands for the gate: a person's keys, a drive to a point, words and the model; by rank."""

DEPTH = 10
"""Queue of an ordinary topic, as everywhere in the course."""
NEWEST = QoSProfile(depth=1, reliability=ReliabilityPolicy.RELIABLE)
"""For those who want the latest message only."""
NEWEST_OF_ANY = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
"""The latest of a topic that may be published reliably or not: both fit."""
LATCHED = QoSProfile(
    depth=1,
    reliability=ReliabilityPolicy.RELIABLE,
    durability=DurabilityPolicy.TRANSIENT_LOCAL,
)
"""A late subscriber gets the last message."""
