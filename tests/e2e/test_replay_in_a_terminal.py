"""`deck replay` in a real terminal, in an environment in which there is no rclpy."""

from __future__ import annotations

import sys
from pathlib import Path

from tests.deck_process import deck
from tests.e2e.terminal import Terminal
from tests.unit.bags import write_bag, write_robot_bag

ROOT = Path(__file__).parents[2]
WORDS_BYTES = 500
"""More than a refusal is long; a screen draws thousands."""
WITHOUT_ROS = """
import sys
for name in ("rclpy", "std_msgs", "sensor_msgs", "builtin_interfaces", "rcl_interfaces"):
    sys.modules[name] = None
from cli import main
sys.exit(main(sys.argv[1:]))
"""


def replay(bag: Path, *options: str) -> Terminal:
    command = [sys.executable, "-c", WITHOUT_ROS, "replay", str(bag), *options]
    return Terminal(command, 80, 24, cwd=str(ROOT))


def test_a_recording_is_played_paused_and_left(tmp_path: Path) -> None:
    terminal = replay(write_robot_bag(tmp_path / "drive"), "--loop", "--rate", "2")
    try:
        terminal.wait_for("recording drive")
        terminal.wait_for("left wheel slower")
        terminal.wait_for("×2")
        terminal.type("\x1b[18~")
        terminal.wait_for("‖")
        terminal.press("2")
        terminal.wait_for("/sensor/sonar_front")
        terminal.press("q")
        assert terminal.wait_exit() == 0
    finally:
        terminal.close()


def test_types_that_are_installed_nowhere_are_shown(tmp_path: Path) -> None:
    terminal = replay(write_bag(tmp_path / "walk"))
    try:
        terminal.wait_for("charging: true")
        terminal.press("q")
        assert terminal.wait_exit() == 0
    finally:
        terminal.close()


def test_what_is_no_bag_is_told_on_the_terminal_with_exit_code_two(tmp_path: Path) -> None:
    terminal = replay(tmp_path / "nothing")
    try:
        assert terminal.wait_exit() == 2
        terminal.wait_for_line("Give the folder that holds")
    finally:
        terminal.close()


def test_what_is_no_bag_at_all_is_told_before_any_screen(tmp_path: Path) -> None:
    link = tmp_path / "l.mcap"
    link.symlink_to(link)
    for path in (Path("/dev/null"), link):
        terminal = replay(path)
        try:
            assert terminal.wait_exit() == 2
            terminal.wait_for_line("is not a bag")
            assert terminal.received < WORDS_BYTES
        finally:
            terminal.close()


def test_without_a_terminal_it_says_what_is_wrong_with_the_bag_first(tmp_path: Path) -> None:
    run = deck("replay", str(tmp_path))
    assert run.process.returncode == 2
    assert "neither metadata.yaml nor an .mcap file" in run.errors[0]
    run = deck("replay", str(write_bag(tmp_path / "walk")))
    assert run.process.returncode == 2
    assert "needs a terminal" in run.errors[0]
