"""What this robot says of itself to the rooms that know none, see `text.robot`."""

from __future__ import annotations

import math

from robot.kinematics import BEHIND_M, LENGTH_M
from robot.topics import (
    AI_COMMAND,
    BRAIN_STATE,
    CAMERA,
    DRIVE,
    DRIVE_SAFE,
    DRIVE_TELEOP,
    GOAL_POSE,
    HEAD_STATE,
    HEARD,
    JOINT_STATES,
    LLM_RAW_JSON,
    MAP,
    MICROPHONE,
    ODOMETRY,
    SAY,
    SONAR_FRAMES,
    SONAR_FRONT,
    SONAR_REAR,
    SPEAKER,
    WHEEL_COMMANDS,
)
from text.i18n import N_
from text.robot import PanelEntry, Robot, SoleTopic

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
    },
    panels={
        "sonar": PanelEntry(N_("sonar"), (SONAR_FRONT, SONAR_REAR)),
        "wheels": PanelEntry(N_("wheels"), (WHEEL_COMMANDS, JOINT_STATES)),
        "map": PanelEntry(N_("map"), (ODOMETRY, MAP)),
        "camera": PanelEntry(N_("camera"), (CAMERA,)),
        "head": PanelEntry(N_("head"), (HEAD_STATE,)),
        "voice": PanelEntry(N_("voice"), (MICROPHONE, SPEAKER)),
        "brain": PanelEntry(N_("brain"), (BRAIN_STATE,)),
        "composer": PanelEntry(N_("composer")),
    },
    words=AI_COMMAND,
    keys=DRIVE_TELEOP,
    moving=frozenset(
        {
            WHEEL_COMMANDS,
            AI_COMMAND,
            LLM_RAW_JSON,
            # The brain obeys a voice, and what was recognised of it.
            MICROPHONE,
            HEARD,
            GOAL_POSE,
        }
    ),
    sole=(
        SoleTopic(
            "gate",
            DRIVE_SAFE,
            "ackermann_msgs/msg/AckermannDriveStamped",
            frozenset({"/safety_node", "/safety_stop"}),
        ),
        SoleTopic("wheels", WHEEL_COMMANDS, "sensor_msgs/msg/JointState", frozenset({"/electronic_differential"})),
    ),
    of_many=frozenset({JOINT_STATES}),
    may_wait=frozenset({HEAD_STATE, JOINT_STATES, SAY, SPEAKER}),
    frames=SONAR_FRAMES,
    mounts={SONAR_FRAMES[SONAR_FRONT]: (LENGTH_M - BEHIND_M, 0.0), SONAR_FRAMES[SONAR_REAR]: (-BEHIND_M, math.pi)},
    story=(MICROPHONE, BRAIN_STATE, LLM_RAW_JSON, AI_COMMAND, DRIVE, DRIVE_SAFE, WHEEL_COMMANDS, HEAD_STATE, SPEAKER),
)
