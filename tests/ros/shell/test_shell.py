"""`deck shell`: the user's shell as it is, plus the lesson's domain, `ros2` and Deck's Python."""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping
from pathlib import Path

import pexpect
import pytest
from std_msgs.msg import String

from launcher.ros_tools import COMMANDS
from tests.ros.peer import Peer
from tests.ros.shell.conftest import DECK, WITHIN_S, Run
from tests.slowness import patient
from tests.waiting import wait_until


def test_a_command_runs_in_the_domain_and_its_exit_code_is_passed_on(run: Run, ros_domain: int) -> None:
    seen = run(
        "echo $ROS_DOMAIN_ID $ROS_AUTOMATIC_DISCOVERY_RANGE; which ros2 python3;"
        " python3 -c 'import rclpy, sys; print(sys.executable)'; exit 7"
    )
    assert seen.returncode == 7
    assert seen.stdout.splitlines() == [
        f"{ros_domain} SYSTEM_DEFAULT",
        str(COMMANDS / "ros2"),
        str(COMMANDS / "python3"),
        sys.executable,
    ]


def test_what_is_published_from_it_is_heard(run: Run, peer: Peer) -> None:
    heard = peer.hear("/ai_command", String)
    seen = run("ros2 topic pub --once /ai_command std_msgs/msg/String 'data: вперёд'")
    assert seen.returncode == 0, seen.stderr
    wait_until(lambda: [message.data for message in heard] == ["вперёд"], "the message")


def test_a_real_ros2_is_preferred_unless_it_is_broken(run: Run, tmp_path: Path) -> None:
    real = tmp_path / "real" / "ros2"
    real.parent.mkdir()
    path = f"{real.parent}:{os.environ['PATH']}"
    for line, wanted in (("exit 0", real), ("exit 1", COMMANDS / "ros2")):
        real.write_text(f"#!/bin/sh\n{line}\n")
        real.chmod(0o755)
        assert run("which ros2", PATH=path).stdout.strip() == str(wanted)


@pytest.mark.parametrize(("shell", "settings", "extra"), [("bash", ".bashrc", {}), ("sh", "shrc", {"ENV": "shrc"})])
def test_the_prompt_tells_the_domain_and_the_users_settings_are_read(
    shell: str, settings: str, extra: Mapping[str, str], home: Path, ros_domain: int
) -> None:
    (home / settings).write_text("PS1='mine> '; PATH=/usr/bin:/bin; tried() { echo it $1; }\n")
    env = {**os.environ, "SHELL": f"/bin/{shell}", **{k: str(home / v) for k, v in extra.items()}}
    terminal = pexpect.spawn(
        DECK[0], list(DECK[1:]), env=env, cwd=str(home), encoding="utf-8", timeout=patient(WITHIN_S)
    )
    terminal.expect_exact(f"(domain {ros_domain}) mine> ")
    terminal.sendline("tried works; which ros2; exit 3")
    terminal.expect_exact("it works")
    terminal.expect_exact(str(COMMANDS / "ros2"))
    terminal.expect(pexpect.EOF)
    terminal.close()
    assert terminal.exitstatus == 3
    assert not list(Path(os.environ.get("TMPDIR", "/tmp")).glob(f"deck-shell-*-{terminal.pid}"))


@pytest.mark.parametrize("own", ["", 'command_not_found_handle() { echo "own word for $1"; }\n'])
def test_what_is_not_there_is_told_with_what_is(own: str, home: Path, ros_domain: int) -> None:
    (home / ".bashrc").write_text(f"PS1='mine> '\n{own}")
    terminal = pexpect.spawn(
        DECK[0], list(DECK[1:]), env={**os.environ, "SHELL": "/bin/bash", "PATH": "/usr/bin:/bin"},
        cwd=str(home), encoding="utf-8", timeout=patient(WITHIN_S),
    )  # fmt: skip
    terminal.expect_exact(f"(domain {ros_domain}) mine> ")
    terminal.sendline("rviz2 --help; echo code $?")
    terminal.expect_exact("rviz2 is not in Deck: the Space tab and `deck view` show frames")
    terminal.expect_exact("code 127")
    terminal.sendline("no_such_program; exit")
    terminal.expect_exact("own word for no_such_program" if own else "no_such_program: command not")
    terminal.expect(pexpect.EOF)
    terminal.close()
