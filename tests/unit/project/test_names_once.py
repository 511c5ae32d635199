"""Names of topics, joints and panels are written once: elsewhere a wrong letter goes unnoticed."""

import ast
from pathlib import Path
from typing import get_args

import pytest

from launcher.profile.panels import Panel
from robot import joints, topics
from tests.rooms import ROOMS
from tui.panels.registry import PANELS

ROOT = Path(__file__).parents[3]
NAMES = {
    value
    for module in (topics, joints)
    for value in vars(module).values()
    if isinstance(value, str) and (value.startswith("/") or value.endswith("_joint"))
}


def _literals(path: Path) -> set[str]:
    tree = ast.parse(path.read_text())
    return {
        node.value
        for node in ast.walk(tree)
        if isinstance(node, ast.Constant) and isinstance(node.value, str)
    }


@pytest.mark.parametrize("room", ROOMS)
def test_a_topic_or_a_joint_is_named_in_one_place(room: str) -> None:
    own = {ROOT / "robot/topics.py", ROOT / "robot/joints.py", ROOT / "text/ros_names.py"}
    again = {
        f"{path.relative_to(ROOT)}: {name}"
        for path in (ROOT / room).rglob("*.py")
        if path not in own
        for name in _literals(path) & NAMES
    }
    assert not again


def test_the_screens_know_the_panels_that_a_profile_may_name() -> None:
    assert tuple(PANELS) == get_args(Panel)
