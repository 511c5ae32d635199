"""The doctor, on machines of every kind and with a model: each fault is found, and has its fix."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterator
from importlib import metadata
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from brain.ladder import Rung
from cli import main
from cli.doctor import checks
from cli.doctor.finding import Finding, Level
from launcher.errors import LauncherError
from launcher.serial_ports import SerialPort
from tests.model_server import KEY, ModelServer, obeys

FULL = {"TERM": "xterm-256color", "COLORTERM": "truecolor"}
PICO = SerialPort("/dev/ttyACM0", "/dev/serial/by-id/usb-Pico", description="Pico")
PI = "Raspberry Pi 5 Model B Rev 1.0"
WHEELS = {
    "rclpy": "/venv/rclpy", "rmw": "rmw_fastrtps_cpp", "error": "", "messages": dict.fromkeys(checks.MESSAGES, "")
}  # fmt: skip


def installed(**versions: str) -> Callable[[str], str]:
    """The versions of packages, all of them the wanted ones but for some."""
    return lambda name: versions.get(name, metadata.version(name))


def ros(environ: dict[str, str] | None = None, machine: str = "x86_64", **found: Any) -> Iterator[Finding]:
    return checks.ros(lambda: {**WHEELS, **found}, environ or {}, machine)


def terminal(environ: dict[str, str], **options: Any) -> Iterator[Finding]:
    return checks.terminal(environ, **{"encoding": "utf-8", "size": (120, 40), "interactive": True, **options})


MACHINES: list[tuple[Iterator[Finding], list[str], str]] = [
    (checks.python((3, 11, 0)), [], ""),
    (checks.python((3, 9, 1)), ["python fail"], "3.10"),
    (checks.python((3, 14, 0)), ["python fail"], "3.13"),
    (checks.python(system="Darwin"), ["machine fail"], "Darwin"),
    (checks.python(version_of=installed(textual="9", numpy="")), ["packages fail", "textual warn"], "numpy"),
    (ros(), [], ""),
    (ros(rclpy="", error="no rclpy"), ["ros.rclpy fail"], "make setup"),
    (ros(rclpy="", error="no rclpy", machine="aarch64"), ["ros.rclpy fail"], "pixi run deck"),
    (ros(error="no middleware"), ["ros.rclpy fail"], "no node can be created"),
    (ros({"ROS_DISTRO": "humble"}), ["ros.distro warn"], "humble"),
    (ros(messages={"std_msgs": "gone"}), ["ros.messages fail"], "std_msgs"),
    (ros(messages={"ackermann_msgs": "no"}), ["ros.messages warn"], "ackermann"),
    (checks.network({"ROS_DOMAIN_ID": "42"}), [], ""),
    (checks.network({"ROS_DOMAIN_ID": "150"}), ["ros.domain warn"], "150"),
    (checks.network({"ROS_DOMAIN_ID": "many"}), ["ros.domain fail"], "many"),
    (checks.network({"ROS_LOCALHOST_ONLY": "1"}), ["ros.localhost_only warn"], ""),
    (checks.network({"ROS_DISCOVERY_SERVER": "h:1"}), ["ros.discovery warn"], ""),
    (checks.network({"RMW_IMPLEMENTATION": "x"}), ["ros.open warn"], ""),
    (terminal(FULL), [], ""),
    (terminal(FULL, encoding="ANSI_X3.4-1968"), ["terminal.encoding warn"], ""),
    (terminal(FULL, size=(79, 40)), ["terminal.size warn"], "79"),
    (terminal({"TERM": "xterm"}), ["terminal.colour warn"], "TERM=xterm-256color"),
    (terminal({}, interactive=False), [], ""),
    (checks.serial(list), [], ""),
    (checks.serial(lambda: [PICO], lambda _: True), [], "usb-Pico"),
    (checks.serial(lambda: [PICO], lambda _: False), ["serial warn"], "sudo usermod -aG"),
]  # fmt: skip
"""What is examined, what is not well there, and words of the text or the fix."""


RASPBERRY = {"proc/device-tree/model": f"{PI}\0"}


def write(root: Path, files: dict[str, str]) -> None:
    for name, content in files.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(content)


def not_well(findings: list[Finding]) -> list[str]:
    """Keys with their levels; whatever is not well has a fix."""
    found = [finding for finding in findings if finding.level is not Level.OK]
    assert all(finding.fix for finding in found)
    return [f"{finding.key} {finding.level.value}" for finding in found]


@pytest.mark.parametrize(("check", "verdict", "words"), MACHINES)
def test_each_fault_is_found_and_mended(check: Iterator[Finding], verdict: list[str], words: str) -> None:
    findings = list(check)
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
    write(tmp_path, {f"{sensor}/name": "rpi_volt\n", f"{sensor}/in0_lcrit_alarm": f"{alarm}\n", **RASPBERRY})
    findings = list(checks.power(tmp_path, lambda: answer))
    assert not_well(findings) == verdict
    assert findings[0].text.startswith(PI)


def test_a_governor_that_keeps_the_cpu_slow(tmp_path: Path) -> None:
    cpu = "sys/devices/system/cpu/cpu0/cpufreq"
    write(tmp_path, {f"{cpu}/scaling_governor": "powersave\n", f"{cpu}/scaling_driver": "cppc_cpufreq\n"})
    assert not_well(list(checks.power(tmp_path))) == ["power.governor warn"]
    write(tmp_path, {f"{cpu}/scaling_driver": "intel_pstate\n"})
    assert not_well(list(checks.power(tmp_path))) == []


def test_cameras_and_sound_cards_that_may_not_be_used(tmp_path: Path) -> None:
    assert not_well(list(checks.media(tmp_path))) == []
    write(tmp_path, {
        "dev/video0": "",
        "sys/class/video4linux/video0/name": "Orbbec\n",
        "proc/asound/cards": " 0 [Device         ]: USB-Audio - USB Audio\n",
        "dev/snd/pcmC0D0p": "",
    })  # fmt: skip
    findings = list(checks.media(tmp_path, lambda _: False))
    assert not_well(findings) == ["camera warn", "sound warn"]
    assert findings[0].text.startswith("camera /dev/video0 Orbbec")
    assert "USB-Audio - USB Audio" in findings[1].text


def test_the_groups_of_a_user_of_the_robot(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Only a Raspberry Pi needs them."""
    assert list(checks.groups(tmp_path)) == []
    write(tmp_path, RASPBERRY)
    monkeypatch.setattr(os, "getuid", lambda: 54321)
    monkeypatch.setenv("USER", "maria")
    (missing,) = checks.groups(tmp_path, ["video"])
    assert missing.level is Level.WARN
    assert "sudo usermod -aG dialout,audio maria" in missing.fix
    (well,) = checks.groups(tmp_path, checks.NEEDED)
    assert well.level is Level.OK


def test_folders_that_cannot_be_used_and_what_is_left_behind(monkeypatch: pytest.MonkeyPatch) -> None:
    stray = SimpleNamespace(pid=77, node="sonar")
    monkeypatch.setattr("launcher.runs.strays.find_strays", lambda: (stray,))
    monkeypatch.setattr("shutil.disk_usage", lambda _: SimpleNamespace(free=1000))
    findings = list(checks.runs())
    assert not_well(findings) == ["folders warn", "strays warn"]
    assert "kill 77" in findings[-1].fix

    def refuse(_: Path) -> None:
        raise LauncherError("/tmp/x is not yours")

    monkeypatch.setattr(checks, "check_writable", refuse)
    (finding,) = checks.runs()
    assert (finding.level, finding.text) == (Level.FAIL, "/tmp/x is not yours")


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
