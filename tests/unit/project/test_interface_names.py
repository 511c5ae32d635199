"""A wrong name in interfaces/ is told by file and line, before anything is built."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.unit.scripts_of_setup import ROOT, load

wrong_names = load("interface_names").wrong_names
FIELD = "the name of a field has small letters, digits and single _, a letter first, no _ last"
TYPE = "the name of a type has letters and digits, a capital first"
CONSTANT = "the name of a constant has capitals, digits and single _, a letter first, no _ last"


@pytest.mark.parametrize(
    ("file", "text", "words"),
    [
        ("msg/Lamp.msg", "# a lamp\nfloat32 Power", f":2: 'Power': {FIELD}: power"),
        ("msg/Lamp.msg", "float32[<=4] wheelSpeed 1.0", f":1: 'wheelSpeed': {FIELD}: wheel_speed"),
        ("srv/Set.srv", "bool on\n---\nstring<=5 my-text", f":3: 'my-text': {FIELD}: my_text"),
        ("action/Go.action", "---\n---\nint8 x_", f":3: 'x_': {FIELD}: x"),
        ("msg/Lamp.msg", "std_msgs/Header 2nd", f":1: '2nd': {FIELD}"),
        ("msg/Lamp.msg", "uint8 On=1", f":1: 'On': {CONSTANT}: ON"),
        ("msg/Lamp.msg", "int8 class", ":1: 'class' is a word of Python or C++, and cannot name a field"),
        ("msg/Lamp.msg", "int8 def", ":1: 'def' is a word of Python or C++, and cannot name a field"),
        ("msg/Lamp.msg", "int8 x\nint8 x", ":2: 'x' stands here a second time, first in line 1"),
        ("msg/Lamp.msg", "double power", ":1: ROS has no type 'double': float64"),
        ("msg/Lamp.msg", "String[] names", ":1: ROS has no type 'String': string"),
        ("msg/Lamp.msg", "lamp x", ":1: ROS has no type 'lamp'"),
        ("msg/Lamp.msg", "uint8 on=1", f":1: 'on': {CONSTANT}: ON"),
        ("msg/Lamp.msg", "uint8 wheel__speed", f":1: 'wheel__speed': {FIELD}: wheel_speed"),
        ("msg/lamp.msg", "float32 power", f": 'lamp': {TYPE}: Lamp"),
        ("srv/set_lamp.srv", "---", f": 'set_lamp': {TYPE}: SetLamp"),
    ],
)
def test_a_wrong_name_is_told(file: str, text: str, words: str, tmp_path: Path) -> None:
    package = tmp_path / "interfaces" / "lamp_msgs"
    (package / file).parent.mkdir(parents=True)
    (package / "package.xml").touch()
    (package / file).write_text(text)
    assert wrong_names(tmp_path / "interfaces") == [f"interfaces/lamp_msgs/{file}{words}"]


def test_what_ros_allows_is_right(tmp_path: Path) -> None:
    assert wrong_names(ROOT / "interfaces") == []
    package = tmp_path / "lamp_msgs"
    (package / "msg").mkdir(parents=True)
    (package / "package.xml").touch()
    (package / "msg" / "Lamp2D.msg").write_text(
        'uint8 KIND_A1 = 1\nstring NAME="a=b # c"\nwstring<=3[2] names\nint32[] v [1, 2]\n'
        'string text "x = y"\n\n# Only a Remark\nbool e\n'
    )
    (package / "srv").mkdir()
    (package / "srv" / "Set.srv").write_text("Lamp2D lamp\n---\nLamp2D lamp\n")
    assert wrong_names(tmp_path) == []
