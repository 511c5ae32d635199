"""The doctor, on machines of every kind: each finding is right, and each fault has its fix."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest

from cli import main
from cli.doctor import Finding, Level
from cli.doctor.login import LoginFacts, before_logout, setting
from cli.doctor.login import diagnose as diagnose_login
from cli.doctor.media import MediaFacts, cards_in
from cli.doctor.media import diagnose as diagnose_media
from cli.doctor.network import NetworkFacts
from cli.doctor.network import diagnose as diagnose_network
from cli.doctor.python import PACKAGES, PythonFacts
from cli.doctor.python import diagnose as diagnose_python
from cli.doctor.ros import MESSAGES, RosFacts
from cli.doctor.ros import diagnose as diagnose_ros
from cli.doctor.runs import RunFacts
from cli.doctor.runs import diagnose as diagnose_runs
from cli.doctor.serial_ports import Access, SerialFacts
from cli.doctor.serial_ports import diagnose as diagnose_serial
from cli.doctor.shared_memory import SharedMemoryFacts
from cli.doctor.shared_memory import diagnose as diagnose_shared_memory
from cli.doctor.terminal import TerminalFacts
from cli.doctor.terminal import diagnose as diagnose_terminal
from launcher.domain.discovery import PROFILES
from launcher.serial_ports import SerialPort

EVERYTHING = dict.fromkeys(PACKAGES, "1.0") | {"textual": "8.2.8"}


def bad(findings: list[Finding]) -> list[tuple[str, str]]:
    """Return (key, level) of what is not well; whatever is not well has a fix."""
    found = [finding for finding in findings if finding.level is not Level.OK]
    assert all(finding.fix for finding in found)
    return [(finding.key, finding.level.value) for finding in found]


def text(findings: list[Finding], key: str) -> str:
    """Return the text and fix of one finding."""
    return " -> ".join(f"{each.text} | {each.fix}" for each in findings if each.key == key)


@pytest.mark.parametrize(
    ("version", "verdict"),
    [
        ((3, 9, 1), [("python", "fail")]),
        ((3, 10, 0), []),
        ((3, 13, 9), []),
        ((3, 14, 0), [("python", "fail")]),
    ],
)
def test_pythons(version: tuple[int, int, int], verdict: list[tuple[str, str]]) -> None:
    facts = PythonFacts(version, "/usr/bin/python3", "Linux", "x86_64", EVERYTHING, "8.2.8")
    assert bad(diagnose_python(facts)) == verdict


def test_another_system_missing_packages_and_another_textual() -> None:
    installed = {"textual": "9.0", "pydantic": "2"}
    facts = PythonFacts((3, 11, 0), "python", "Darwin", "arm64", installed, "8.2.8")
    findings = diagnose_python(facts)
    assert bad(findings) == [("machine", "fail"), ("packages", "fail"), ("textual", "warn")]
    assert "pip install textual==8.2.8" in text(findings, "textual")
    assert "PyYAML psutil numpy pyserial setproctitle" in text(findings, "packages")


WHEELS = RosFacts(
    rclpy="/venv/lib/python3.11/site-packages/rclpy/__init__.py",
    rmw="rmw_fastrtps_cpp",
    messages=dict.fromkeys(MESSAGES, ""),
    wheels="7.1.4",
)


@pytest.mark.parametrize(
    ("rclpy", "environ", "origin"),
    [
        (
            "/opt/ros/jazzy/lib/python3.12/site-packages/rclpy/__init__.py",
            {"ROS_DISTRO": "jazzy"},
            "jazzy from the distribution",
        ),
        (
            "/pixi/envs/default/lib/python3.12/site-packages/rclpy/__init__.py",
            {"CONDA_PREFIX": "/pixi/envs/default", "ROS_DISTRO": "jazzy"},
            "jazzy from RoboStack",
        ),
        (
            "/ws/install/lib/python3/site-packages/rclpy/__init__.py",
            {"AMENT_PREFIX_PATH": "/x:/ws/install", "ROS_DISTRO": "jazzy"},
            "jazzy, sourced",
        ),
    ],
)
def test_where_ros_comes_from(rclpy: str, environ: dict[str, str], origin: str) -> None:
    facts = RosFacts(rclpy, "rmw_fastrtps_cpp", "", WHEELS.messages, environ)
    findings = diagnose_ros(facts)
    assert bad(findings) == []
    assert origin in text(findings, "ros.distro")


def test_wheels_from_pypi_also_where_they_have_set_the_paths_themselves() -> None:
    facts = replace(WHEELS, environ={"AMENT_PREFIX_PATH": "/venv"})
    assert "wheels from PyPI (rclpy 7.1.4)" in text(diagnose_ros(facts), "ros.distro")


def test_no_ros_at_all_is_a_failure_with_the_mend_for_the_machine() -> None:
    here = diagnose_ros(RosFacts(error="ModuleNotFoundError: No module named 'rclpy'"))
    on_a_pi = diagnose_ros(RosFacts(error="no rclpy", machine="aarch64"))
    assert bad(here) == bad(on_a_pi) == [("ros.rclpy", "fail")]
    assert "make setup" in text(here, "ros.rclpy")
    assert "pixi run deck" in text(on_a_pi, "ros.rclpy")
    assert "make setup" not in text(on_a_pi, "ros.rclpy")


def test_another_distribution_is_warned_of() -> None:
    facts = RosFacts(WHEELS.rclpy, "x", "", WHEELS.messages, {"ROS_DISTRO": "humble"})
    assert bad(diagnose_ros(facts)) == [("ros.distro", "warn")]


def test_a_middleware_that_is_not_installed() -> None:
    facts = RosFacts(
        rclpy=WHEELS.rclpy,
        error="RMW not found",
        messages=WHEELS.messages,
        environ={"RMW_IMPLEMENTATION": "rmw_cyclonedds_cpp"},
    )
    findings = diagnose_ros(facts)
    assert bad(findings) == [("ros.rclpy", "fail")]
    assert "unset RMW_IMPLEMENTATION" in text(findings, "ros.rclpy")


@pytest.mark.parametrize(("package", "level"), [("ackermann_msgs", "warn"), ("std_msgs", "fail")])
def test_missing_messages(package: str, level: str) -> None:
    messages = {**WHEELS.messages, package: "No module named"}
    findings = diagnose_ros(RosFacts(WHEELS.rclpy, "x", "", messages))
    assert bad(findings) == [("ros.messages", level)]
    assert package in text(findings, "ros.messages")


@pytest.mark.parametrize(
    ("environ", "verdict"),
    [
        ({}, []),
        ({"ROS_DOMAIN_ID": "42"}, []),
        ({"ROS_DOMAIN_ID": "150"}, [("ros.domain", "warn")]),
        ({"ROS_DOMAIN_ID": "many"}, [("ros.domain", "fail")]),
        ({"ROS_LOCALHOST_ONLY": "1"}, [("ros.localhost_only", "warn")]),
        ({"ROS_LOCALHOST_ONLY": "0"}, []),
        ({"ROS_DISCOVERY_SERVER": "10.0.0.1:11811"}, [("ros.discovery", "warn")]),
        ({"FASTDDS_DEFAULT_PROFILES_FILE": "/mine.xml"}, [("ros.open", "warn")]),
        ({"FASTRTPS_DEFAULT_PROFILES_FILE": str(PROFILES)}, []),
        ({"RMW_IMPLEMENTATION": "rmw_cyclonedds_cpp"}, [("ros.open", "warn")]),
    ],
)
def test_domains_and_discovery(environ: dict[str, str], verdict: list[tuple[str, str]]) -> None:
    assert bad(diagnose_network(NetworkFacts(environ))) == verdict


GOOD_TERMINAL = {"TERM": "xterm-256color", "COLORTERM": "truecolor"}


@pytest.mark.parametrize(
    ("facts", "verdict"),
    [
        (TerminalFacts(environ=GOOD_TERMINAL), []),
        (TerminalFacts(environ={"TERM": "xterm-kitty", "COLORTERM": "truecolor"}), []),
        (TerminalFacts(environ={"TERM": "xterm-256color"}), [("terminal.colour", "warn")]),
        (
            TerminalFacts(environ={**GOOD_TERMINAL, "NO_COLOR": "1"}),
            [("terminal.colour", "warn")],
        ),
        (
            TerminalFacts(environ={"TERM": "dumb"}),
            [("terminal", "warn"), ("terminal.colour", "warn")],
        ),
        (
            TerminalFacts(environ=GOOD_TERMINAL, encoding="ANSI_X3.4-1968"),
            [("terminal.encoding", "warn")],
        ),
        (TerminalFacts(environ=GOOD_TERMINAL, columns=79), [("terminal.size", "warn")]),
        (TerminalFacts(environ=GOOD_TERMINAL, columns=80, lines=24), []),
        (TerminalFacts(is_terminal=False), []),
    ],
)
def test_terminals(facts: TerminalFacts, verdict: list[tuple[str, str]]) -> None:
    assert bad(diagnose_terminal(facts)) == verdict


def test_a_serial_port_without_permission_names_the_group_and_the_lasting_name() -> None:
    pico = SerialPort("/dev/ttyACM0", "/dev/serial/by-id/usb-Pico", description="Pico")
    port = Access(pico, "dialout", allowed=False)
    outside = diagnose_serial(SerialFacts((port,), "maria", ("users",)))
    inside = diagnose_serial(SerialFacts((port,), "maria", ("dialout",)))
    assert bad(outside) == bad(inside) == [("serial", "warn")]
    assert "usb-Pico (Pico): no permission" in text(outside, "serial")
    assert "sudo usermod -aG dialout maria" in text(outside, "serial")
    assert "udev" in text(inside, "serial")


def test_serial_ports_that_may_be_opened_and_none_at_all() -> None:
    port = Access(SerialPort("/dev/ttyUSB0", description="CP2102"), "dialout")
    findings = diagnose_serial(SerialFacts((port,)))
    assert bad(findings) == []
    assert "serial port /dev/ttyUSB0 (CP2102)" in text(findings, "serial")
    assert bad(diagnose_serial(SerialFacts())) == []
    assert bad(diagnose_serial(SerialFacts(error="no pyserial"))) == [("serial", "warn")]


def test_shared_memory() -> None:
    assert bad(diagnose_shared_memory(SharedMemoryFacts())) == []
    assert bad(diagnose_shared_memory(SharedMemoryFacts(free=10_000_000))) == [("shm", "warn")]
    assert bad(diagnose_shared_memory(SharedMemoryFacts(exists=False))) == [("shm", "warn")]
    stale = diagnose_shared_memory(SharedMemoryFacts(stale=3, stale_bytes=1_500_000))
    assert bad(stale) == [("shm.stale", "warn")]
    assert "3 unused segments" in text(stale, "shm.stale")
    (fix,) = [one.fix for one in stale if one.key == "shm.stale"]
    assert "rm /dev/shm" not in fix, "those of other users are there too"
    assert "find /dev/shm -maxdepth 1 -user $(id -un) -name 'fastrtps_*' -delete" in fix
    half = diagnose_shared_memory(SharedMemoryFacts(unfinished=("/dev/shm/fastrtps_port7001",)))
    assert bad(half) == [("shm.unfinished", "warn")]
    assert "/dev/shm/fastrtps_port7001: incomplete" in text(half, "shm.unfinished")
    foreign = diagnose_shared_memory(SharedMemoryFacts(foreign=("/dev/shm/fastrtps_port7001",)))
    assert bad(foreign) == [("shm.foreign", "fail")]
    assert foreign[-1].fix == "sudo rm /dev/shm/fastrtps_port7001"


@pytest.mark.parametrize("term", ["xterm", "screen", "linux"])
def test_a_terminal_of_few_colours_is_told_how_to_have_more(term: str) -> None:
    colour = [one for one in diagnose_terminal(TerminalFacts(environ={"TERM": term})) if one.fix]
    assert [one.key for one in colour] == ["terminal.colour"]
    assert "TERM=xterm-256color" in colour[0].fix


@pytest.mark.parametrize(
    ("term", "drawn"),
    [
        ("alacritty", "16 colours"),
        ("foot", "16 colours"),
        ("xterm-direct", "16 colours"),
        ("xterm-ghostty", "16 colours"),
        ("xterm-kitty", "256 colours"),
    ],
)
def test_a_terminal_that_can_do_more_than_is_drawn_is_told_how_to_say_so(
    term: str, drawn: str
) -> None:
    found = diagnose_terminal(TerminalFacts(environ={"TERM": term}))
    assert drawn in text(found, "terminal.colour")
    assert "COLORTERM=truecolor" in text(found, "terminal.colour")


@pytest.mark.parametrize(
    ("facts", "verdict"),
    [
        (LoginFacts(logind=False), []),
        (LoginFacts(logind=True), [("login.remove_ipc", "warn")]),
        (LoginFacts(logind=True, remove_ipc=False), []),
        (LoginFacts(logind=True, lingers=True), []),
        (LoginFacts(logind=True, uid=0), []),
    ],
)
def test_logging_out(facts: LoginFacts, verdict: list[tuple[str, str]]) -> None:
    assert bad(diagnose_login(facts)) == verdict


def test_up_says_in_a_login_that_logging_out_ends_it() -> None:
    lines = before_logout(LoginFacts(logind=True), {"XDG_SESSION_ID": "3"})
    assert "`deck up` lose each other" in lines[0]
    assert "loginctl enable-linger" in lines[1]
    assert before_logout(LoginFacts(logind=True), {}) == []
    assert before_logout(LoginFacts(logind=True, lingers=True), {"XDG_SESSION_ID": "3"}) == []


@pytest.mark.parametrize(
    ("texts", "removes"),
    [
        ([], True),
        (["[Login]\n#RemoveIPC=yes\n"], True),
        (["[Login]\nRemoveIPC=no\n"], False),
        (["[Login]\nRemoveIPC=no\n", "[Login]\nRemoveIPC = yes\n"], True),
        (["[Login]\nremoveipc=False"], False),
    ],
)
def test_what_logind_is_set_to(texts: list[str], removes: bool) -> None:
    assert setting(texts) is removes


def test_cameras_and_sound() -> None:
    assert bad(diagnose_media(MediaFacts())) == []
    facts = MediaFacts((("/dev/video0", "Orbbec", False),), ("USB Audio",), sound_allowed=False)
    findings = diagnose_media(facts)
    assert bad(findings) == [("camera", "warn"), ("sound", "warn")]
    assert "/dev/video0 Orbbec" in text(findings, "camera")


def test_speech_that_is_not_installed_is_told_with_the_command() -> None:
    (missing,) = [
        one for one in diagnose_media(MediaFacts(no_speech=("a", "b"))) if one.key == "speech"
    ]
    assert (
        missing.text
        == "speech offline: without a, b; to hear and speak: pip install 'deck-robot[voice]'"
    )


def test_names_of_sound_cards() -> None:
    listing = " 0 [PCH ]: HDA-Intel - HDA Intel PCH\n            HDA at 0x1 irq 1\n"
    assert cards_in(listing) == ["HDA-Intel - HDA Intel PCH"]
    assert cards_in("--- no soundcards ---\n") == []


def test_strays_full_disks_and_folders_of_others() -> None:
    assert bad(diagnose_runs(RunFacts())) == []
    strays = diagnose_runs(RunFacts(strays=((77, "sonar"), (78, "camera"))))
    assert bad(strays) == [("strays", "warn")]
    assert "sonar (77), camera (78)" in text(strays, "strays")
    assert "kill 77 78" in text(strays, "strays")
    assert bad(diagnose_runs(RunFacts(free=1000))) == [("folders", "warn")]
    assert bad(diagnose_runs(RunFacts(error="/tmp/x belongs to somebody else"))) == [
        ("folders", "fail")
    ]


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
    assert capsys.readouterr().out.splitlines() == [
        "ok    fine",
        "FAIL  gone",
        "      -> bring it",
    ]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--domain", "7"], "--domain goes with --graph"),
        (["llm", "--graph"], "--graph does not go with llm"),
        (["--graph", "--domain", "999"], "999"),
    ],
)
def test_options_that_make_no_sense_are_refused(
    words: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["doctor", *words]) == 2
    assert said in capsys.readouterr().err
