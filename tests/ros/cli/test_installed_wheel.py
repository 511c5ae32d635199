"""An installed wheel at work: a lesson, and one node alone, beside packages of the same names."""

from __future__ import annotations

import shlex

import pytest

from tests.installed_wheel import Installed


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Installed:
    """The wheel, installed beside a `graph`, a `text` and the rest that are somebody else's."""
    return Installed(tmp_path_factory.mktemp("installed"))


@pytest.mark.parametrize("warm", ["true", "false"])
@pytest.mark.usefixtures("ros_domain")
def test_a_lesson_runs(installed: Installed, warm: str) -> None:
    profile = installed.site.parent / "mine.yaml"
    profile.write_text(
        f"extends: 02-sonar-safety\nnodes: {{sonar_front: {{warm: {warm}}}, safety_stop: {{warm: {warm}}}}}\n"
    )
    said = installed.deck("run", str(profile), "--for", "4", "--lang", "en")
    assert "[sonar_front]" in said
    assert "every node" in said
    assert not installed.imported.exists()


@pytest.mark.usefixtures("ros_domain")
def test_a_node_runs_alone(installed: Installed) -> None:
    words = ("--ros-args", "-p", "no_such_parameter:=1")
    said = installed.python("-m", "deck.nodes.hello", *words, code=2)
    assert "no_such_parameter" in said
    assert not installed.imported.exists()


@pytest.mark.usefixtures("ros_domain")
def test_the_commands_of_the_shell_are_executable(installed: Installed) -> None:
    """A wheel is a zip, which need not keep who may execute a file."""
    (installed.site.parent / "mine.py").write_text("import cv_bridge, no_such_module\n")
    line = (
        "which ros2 python3; ros2 pkg executables tf2_ros; ros2 run deck_nodes hello --help;"
        f" python3 {shlex.quote(str(installed.site.parent / 'mine.py'))}"
    )
    said = installed.deck("shell", "-c", line, code=1)
    commands = installed.site / "deck" / "launcher" / "prefix" / "bin"
    assert said.startswith(f"{commands / 'ros2'}\n{commands / 'python3'}\n"), said
    assert "\ntf2_ros static_transform_publisher\ntf2_ros tf2_echo\n" in said
    assert "--ros-args" in said
    assert "mine.py:1: The module no_such_module is not installed" in said
    assert not installed.imported.exists()
