"""`deck shell`: the user's shell as it is, plus the lesson's domain, `ros2` and Deck's Python."""

from __future__ import annotations

import os
import shlex
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

import pexpect
import pytest

from launcher.ros_tools import COMMANDS
from tests.ros.shell.conftest import DECK, WITHIN_S, Run


def test_a_command_runs_in_the_domain_and_its_exit_code_is_passed_on(
    run: Run, ros_domain: int
) -> None:
    seen = run(
        "echo $ROS_DOMAIN_ID $ROS_AUTOMATIC_DISCOVERY_RANGE; which ros2 python3;"
        " python3 -c 'import rclpy, sys; print(sys.executable)'; exit 7"
    )
    assert seen.returncode == 7
    assert seen.stdout.splitlines() == [
        f"{ros_domain} LOCALHOST",
        str(COMMANDS / "ros2"),
        str(COMMANDS / "python3"),
        sys.executable,
    ]


def test_within_a_shell_there_can_be_another(run: Run) -> None:
    seen = run(f"{shlex.join(DECK)} -c 'echo $PATH; which ros2'")
    path, ros2 = seen.stdout.splitlines()
    assert path.split(":").count(str(COMMANDS)) == 1
    assert ros2 == str(COMMANDS / "ros2")


def test_a_real_ros2_is_preferred_unless_it_is_broken(run: Run, tmp_path: Path) -> None:
    real = tmp_path / "real" / "ros2"
    real.parent.mkdir()
    path = f"{real.parent}:{os.environ['PATH']}"
    for line, wanted in (("exit 0", real), ("exit 1", COMMANDS / "ros2")):
        real.write_text(f"#!/bin/sh\n{line}\n")
        real.chmod(0o755)
        assert run("which ros2", PATH=path).stdout.strip() == str(wanted)


@pytest.mark.parametrize(
    ("shell", "settings", "extra"),
    [("bash", ".bashrc", {}), ("sh", "shrc", {"ENV": "shrc"})],
)
def test_the_prompt_tells_the_domain_and_the_users_settings_are_read(
    shell: str, settings: str, extra: Mapping[str, str], home: Path, ros_domain: int
) -> None:
    (home / settings).write_text("PS1='mine> '; PATH=/usr/bin:/bin; tried() { echo it $1; }\n")
    env = {**os.environ, "SHELL": f"/bin/{shell}", **{k: str(home / v) for k, v in extra.items()}}
    terminal = pexpect.spawn(
        DECK[0], list(DECK[1:]), env=env, cwd=str(home), encoding="utf-8", timeout=WITHIN_S
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
        cwd=str(home), encoding="utf-8", timeout=WITHIN_S,
    )  # fmt: skip
    terminal.expect_exact(f"(domain {ros_domain}) mine> ")
    terminal.sendline("rviz2 --help; echo code $?")
    terminal.expect_exact("rviz2 is not in Deck: the Space tab and `deck view` show frames")
    terminal.expect_exact("code 127")
    terminal.sendline("no_such_program; exit")
    terminal.expect_exact("own word for no_such_program" if own else "no_such_program: command not")
    terminal.expect(pexpect.EOF)
    terminal.close()


def test_without_a_terminal_it_reads_its_commands(home: Path, ros_domain: int) -> None:
    seen = subprocess.run(
        DECK,
        cwd=home,
        input="echo $ROS_DOMAIN_ID\nexit 4\n",
        capture_output=True,
        text=True,
        timeout=WITHIN_S,
        check=False,
    )
    assert (seen.stdout, seen.returncode) == (f"{ros_domain}\n", 4)
