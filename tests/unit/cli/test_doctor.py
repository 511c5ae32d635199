"""The doctor, on machines of every kind and with a model: each fault is found, and has its fix."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from brain.ladder import Rung
from cli import main
from cli.doctor import Finding, Level, groups, media, network, power, python, ros, runs, serial_ports, terminal
from launcher.serial_ports import SerialPort
from tests.model_server import KEY, ModelServer, obeys

PACKAGES = dict.fromkeys(python.PACKAGES, "1.0") | {"textual": "8.2.8"}
PYTHON = python.PythonFacts((3, 11, 0), "python3", "Linux", "x86_64", PACKAGES, "8.2.8")
WHEELS = ros.RosFacts("/venv/rclpy", "rmw_fastrtps_cpp", "", dict.fromkeys(ros.MESSAGES, ""))
TERMINAL = terminal.TerminalFacts(environ={"TERM": "xterm-256color", "COLORTERM": "truecolor"})
PICO = serial_ports.Access(
    SerialPort("/dev/ttyACM0", "/dev/serial/by-id/usb-Pico", description="Pico"), "dialout", allowed=False
)
PI = "Raspberry Pi 5 Model B Rev 1.0"

MACHINES: list[tuple[Any, Any, list[str], str]] = [
    (python, PYTHON, [], ""),
    (python, replace(PYTHON, version=(3, 9, 1)), ["python fail"], "3.10"),
    (python, replace(PYTHON, version=(3, 14, 0)), ["python fail"], "3.13"),
    (python, replace(PYTHON, system="Darwin"), ["machine fail"], "Darwin"),
    (python, replace(PYTHON, installed={"textual": "9"}), ["packages fail", "textual warn"],
     "numpy"),
    (ros, WHEELS, [], ""),
    (ros, ros.RosFacts(error="no rclpy"), ["ros.rclpy fail"], "make setup"),
    (ros, ros.RosFacts(error="no rclpy", machine="aarch64"), ["ros.rclpy fail"], "pixi run deck"),
    (ros, replace(WHEELS, environ={"ROS_DISTRO": "humble"}), ["ros.distro warn"], "humble"),
    (ros, replace(WHEELS, messages={"std_msgs": "gone"}), ["ros.messages fail"], "std_msgs"),
    (ros, replace(WHEELS, messages={"ackermann_msgs": "no"}), ["ros.messages warn"], "ackermann"),
    (network, network.NetworkFacts({"ROS_DOMAIN_ID": "42"}), [], ""),
    (network, network.NetworkFacts({"ROS_DOMAIN_ID": "150"}), ["ros.domain warn"], "150"),
    (network, network.NetworkFacts({"ROS_DOMAIN_ID": "many"}), ["ros.domain fail"], "many"),
    (network, network.NetworkFacts({"ROS_LOCALHOST_ONLY": "1"}), ["ros.localhost_only warn"], ""),
    (network, network.NetworkFacts({"ROS_DISCOVERY_SERVER": "h:1"}), ["ros.discovery warn"], ""),
    (network, network.NetworkFacts({"RMW_IMPLEMENTATION": "x"}), ["ros.open warn"], ""),
    (terminal, TERMINAL, [], ""),
    (terminal, replace(TERMINAL, encoding="ANSI_X3.4-1968"), ["terminal.encoding warn"], ""),
    (terminal, replace(TERMINAL, columns=79), ["terminal.size warn"], "79"),
    (terminal, terminal.TerminalFacts(environ={"TERM": "xterm"}), ["terminal.colour warn"],
     "TERM=xterm-256color"),
    (terminal, terminal.TerminalFacts(is_terminal=False), [], ""),
    (serial_ports, serial_ports.SerialFacts(), [], ""),
    (serial_ports, serial_ports.SerialFacts((PICO,), "maria", ("users",)), ["serial warn"],
     "sudo usermod -aG dialout maria"),
    (serial_ports, serial_ports.SerialFacts((PICO,), "maria", ("dialout",)), ["serial warn"],
     "udev"),
    (media, media.MediaFacts(), [], ""),
    (media, media.MediaFacts((("/dev/video0", "Orbbec", False),), ("USB",), sound_allowed=False),
     ["camera warn", "sound warn"], "/dev/video0 Orbbec"),
    (runs, runs.RunFacts(), [], ""),
    (runs, runs.RunFacts(strays=((77, "sonar"), (78, "camera"))), ["strays warn"], "kill 77 78"),
    (runs, runs.RunFacts(apart=("robot (domain 5, supervisor 77)",)), [], ""),
    (runs, runs.RunFacts(free=1000), ["folders warn"], ""),
    (runs, runs.RunFacts(error="/tmp/x is not yours"), ["folders fail"], "not yours"),
    (groups, groups.GroupFacts(pi=False, mine=()), [], ""),
    (groups, groups.GroupFacts(pi=True, user="maria", mine=("video",)), ["groups warn"],
     "sudo usermod -aG dialout,audio maria"),
]  # fmt: skip
"""What is examined, what is found there, what is not well, and words of the text or the fix."""


def not_well(findings: list[Finding]) -> list[str]:
    """Keys with their levels; whatever is not well has a fix."""
    found = [finding for finding in findings if finding.level is not Level.OK]
    assert all(finding.fix for finding in found)
    return [f"{finding.key} {finding.level.value}" for finding in found]


@pytest.mark.parametrize(("room", "facts", "verdict", "words"), MACHINES)
def test_each_fault_is_found_and_mended(room: Any, facts: Any, verdict: list[str], words: str) -> None:
    findings = room.diagnose(facts)
    assert not_well(findings) == verdict
    assert words in "\n".join(f"{finding.text} {finding.fix}" for finding in findings)


@pytest.mark.parametrize(
    ("answer", "alarm", "verdict"),
    [
        ("throttled=0x0\n", "", []),
        ("throttled=0x1\n", "", ["power.voltage warn"]),
        ("throttled=0x10000\n", "", ["power.voltage warn"]),
        ("throttled=0x50005\n", "", ["power.voltage warn", "power.throttled warn"]),
        # Without vcgencmd the kernel's sensor tells.
        ("throttled=?", "1", ["power.voltage warn"]),
        ("", "0", []),
    ],
)
def test_the_supply_of_a_pi(answer: str, alarm: str, verdict: list[str], tmp_path: Path) -> None:
    sensor = "sys/class/hwmon/hwmon1"
    for name, content in (
        ("proc/device-tree/model", f"{PI}\0"),
        (f"{sensor}/name", "rpi_volt\n"),
        (f"{sensor}/in0_lcrit_alarm", f"{alarm}\n"),
    ):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(content)
    findings = power.diagnose(power.collect(tmp_path, lambda: answer))
    assert not_well(findings) == verdict
    assert findings[0].text.startswith(PI)


def test_this_machine_can_run_deck(capsys: pytest.CaptureFixture[str]) -> None:
    code = main(["doctor", "--json"])
    findings = json.loads(capsys.readouterr().out)
    assert {"key", "level", "text", "mend"} == set(findings[0])
    assert code == 0, [finding for finding in findings if finding["level"] == "fail"]
    assert {"python", "ros.rclpy", "ros.messages"} <= {finding["key"] for finding in findings}


def test_the_lines_say_the_level_in_words(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    findings = [Finding("a", Level.OK, "fine"), Finding("b", Level.FAIL, "gone", "bring it")]
    monkeypatch.setattr("cli.doctor.command.examine", lambda: findings)
    assert main(["doctor"]) == 1
    said = ["ok    fine", "FAIL  gone", "      -> bring it"]
    assert capsys.readouterr().out.splitlines() == said


HELLO = json.dumps({"thought": "a test", "commands": [], "say": "Hello!"})


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A user's own folders, without settings."""
    for name in ("XDG_CONFIG_HOME", "XDG_CACHE_HOME"):
        monkeypatch.setenv(name, str(tmp_path))
    (tmp_path / "deck").mkdir()
    return tmp_path / "deck"


def set_up(home: Path, server: ModelServer) -> None:
    (home / "key").write_text(KEY)
    (home / "key").chmod(0o600)
    (home / "llm.yaml").write_text(f"base_url: {server.url}\nmodel: m-1\nkey_file: {home}/key\n")


@pytest.mark.parametrize("rung", [Rung.STRICT, Rung.TOOL])
def test_a_model_that_answers(home: Path, capsys: pytest.CaptureFixture[str], rung: Rung) -> None:
    with ModelServer(obeys(HELLO, rung)) as server:
        set_up(home, server)
        assert main(["doctor", "llm"]) == 0
        again = len(server.exchanges)
        main(["doctor", "llm"])
        assert len(server.exchanges) == 2 * again, "the doctor finds out anew each time"
    said = capsys.readouterr().out
    assert f"m-1 at {server.url}" in said
    assert f"answers as {rung.value}" in said
    assert "first token after" in said
    assert f"{again} requests" in said
    assert KEY not in said


def test_a_model_that_does_not(home: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Exit code 1, the reason and the mend; also for programs."""
    with ModelServer(lambda exchange: exchange.fails(401, KEY)) as server:
        set_up(home, server)
        assert main(["doctor", "llm", "--json"]) == 1
    output = capsys.readouterr().out
    found = {each["key"]: each for each in json.loads(output)}
    assert found["llm.answer"]["text"] == "the server does not take the key (401)"
    assert found["llm.answer"]["mend"] == "key_env or key_file in llm.yaml"
    assert KEY not in output
