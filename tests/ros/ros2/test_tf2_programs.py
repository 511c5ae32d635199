"""What `ros2 run tf2_ros ...` starts: transforms from a command line, and back as the real text."""

from __future__ import annotations

import math

import pytest
from geometry_msgs.msg import Transform

from ros2.programs.static_transform_publisher import read
from ros2.programs.tf2_echo import described

NEW = "--x 0.15 --z 0.25 --yaw 0.3 --pitch -0.2 --frame-id base_link --child-frame-id eye"
QUATERNION = "--qz 0.6 --qw 0.8 --frame-id base_link --child-frame-id eye"
TURNED = """\
- Translation: [0.150, 0.000, 0.250]
- Rotation: in Quaternion (xyzw) [0.015, -0.099, 0.149, 0.984]
- Rotation: in RPY (radian) [0.000, -0.200, 0.300]
- Rotation: in RPY (degree) [0.000, -11.459, 17.189]
- Matrix:
  0.936 -0.296 -0.190  0.150
  0.290  0.955 -0.059  0.000
  0.199  0.000  0.980  0.250
  0.000  0.000  0.000  1.000"""


def test_both_styles_of_arguments_mean_the_same() -> None:
    new = read(NEW.split())
    assert (new.header.frame_id, new.child_frame_id) == ("base_link", "eye")
    assert read(["0.15", "0", "0.25", "0.3", "-0.2", "0", "base_link", "eye"]) == new
    turned = read(["0", "0", "0", "0", "0", "0.6", "0.8", "base_link", "eye"])
    assert turned == read(QUATERNION.split())
    assert turned.transform.rotation.z == pytest.approx(0.6)


def test_a_transform_is_described_as_by_the_real_program() -> None:
    text = described(read(NEW.split()).transform)
    assert text.replace("-0.000", "0.000") == TURNED
    straight = described(Transform())
    assert "Quaternion (xyzw) [0.000, 0.000, 0.000, 1.000]" in straight
    up = described(read(["0", "0", "0", "0", "1.5707963267948966", "0", "a", "b"]).transform)
    assert f"RPY (degree) [0.000, {math.degrees(math.pi / 2):.3f}, 0.000]" in up.replace("-0.0", "0.0")
