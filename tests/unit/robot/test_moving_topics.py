"""Which recorded topics would move a robot."""

from __future__ import annotations

import pytest

from robot.safety.moving_topics import moves

DRIVE = "ackermann_msgs/msg/AckermannDriveStamped"
TEXT = "std_msgs/msg/String"


@pytest.mark.parametrize(
    ("name", "type_name"),
    [
        *((topic, DRIVE) for topic in ("/drive", "/drive_teleop", "/drive_action", "/drive_safe")),
        ("/wheel_commands", "sensor_msgs/msg/JointState"),
        ("/ai_command", TEXT),
        ("/llm_raw_json", TEXT),
        ("/audio/mic_raw", "std_msgs/msg/ByteMultiArray"),
        ("/audio/heard", TEXT),
        ("/cmd_vel", "geometry_msgs/msg/Twist"),
    ],
)
def test_commands_move_it(name: str, type_name: str) -> None:
    assert moves(name, type_name)


@pytest.mark.parametrize(
    ("name", "type_name"),
    [
        ("/sensor/sonar_front", "std_msgs/msg/Float32"),
        ("/head_state", "sensor_msgs/msg/JointState"),
        ("/camera/color/image_raw", "sensor_msgs/msg/Image"),
        ("/llm_result", TEXT),
    ],
)
def test_what_it_tells_does_not(name: str, type_name: str) -> None:
    assert not moves(name, type_name)
