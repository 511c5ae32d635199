"""The doctor on the robot's own computer: supply, speed, groups, and what ports look like."""

from __future__ import annotations

from pathlib import Path

import pytest

from cli.doctor import groups, power, serial_ports
from cli.doctor.groups import GroupFacts
from cli.doctor.power import PowerFacts
from cli.doctor.serial_ports import Access, SerialFacts
from launcher.serial_ports import SerialPort
from tests.unit.cli.test_doctor import bad, text

PI = "Raspberry Pi 5 Model B Rev 1.0"


def machine(root: Path, files: dict[str, str]) -> Path:
    """Write what a machine tells of itself."""
    for name, content in files.items():
        path = root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(content)
    return root


@pytest.mark.parametrize(
    ("answer", "verdict"),
    [
        ("throttled=0x0\n", []),
        ("throttled=0x1\n", ["power.voltage"]),
        ("throttled=0x10000\n", ["power.voltage"]),
        ("throttled=0x4\n", ["power.throttled"]),
        ("throttled=0x80000\n", ["power.throttled"]),
        ("throttled=0x50005\n", ["power.voltage", "power.throttled"]),
    ],
)
def test_the_supply_of_a_pi(answer: str, verdict: list[str], tmp_path: Path) -> None:
    root = machine(tmp_path, {"proc/device-tree/model": f"{PI}\0"})
    findings = power.diagnose(power.collect(root, lambda: answer))
    assert bad(findings) == [(key, "warn") for key in verdict]
    assert findings[0].text.startswith(PI)


def test_low_voltage_now_and_before_are_two_things(tmp_path: Path) -> None:
    root = machine(tmp_path, {"proc/device-tree/model": PI})
    now = power.diagnose(power.collect(root, lambda: "throttled=0x10001"))
    before = power.diagnose(power.collect(root, lambda: "throttled=0x10000"))
    assert "low voltage now | use a 5 V, 5 A supply" in text(now, "power.voltage")
    assert "low voltage since power-on" in text(before, "power.voltage")


@pytest.mark.parametrize("answer", ["", "VCHI initialization failed\n", "throttled=?"])
@pytest.mark.parametrize(("alarm", "verdict"), [("1", ["power.voltage"]), ("0", [])])
def test_without_vcgencmd_the_kernels_sensor_tells(
    answer: str, alarm: str, verdict: list[str], tmp_path: Path
) -> None:
    root = machine(
        tmp_path,
        {
            "proc/device-tree/model": PI,
            "sys/class/hwmon/hwmon0/name": "cpu_thermal\n",
            "sys/class/hwmon/hwmon1/name": "rpi_volt\n",
            "sys/class/hwmon/hwmon1/in0_lcrit_alarm": f"{alarm}\n",
        },
    )
    found = power.diagnose(power.collect(root, lambda: answer))
    assert bad(found) == [(key, "warn") for key in verdict]


def test_a_laptop_is_not_asked_for_its_supply(tmp_path: Path) -> None:
    def fail() -> str:
        raise AssertionError("no Pi has been seen")

    root = machine(tmp_path, {"proc/device-tree/model": "Some Board"})
    assert power.collect(root, fail) == PowerFacts()
    assert power.diagnose(power.collect(tmp_path / "nothing", fail)) == []


@pytest.mark.parametrize(
    ("governor", "driver", "warned"),
    [
        ("powersave", "cpufreq-dt", True),
        ("powersave", "intel_pstate", False),
        ("powersave", "amd-pstate-epp", False),
        ("ondemand", "cpufreq-dt", False),
        ("performance", "", False),
    ],
)
def test_a_cpu_that_saves_power(governor: str, driver: str, warned: bool, tmp_path: Path) -> None:
    cpu = "sys/devices/system/cpu/cpu0/cpufreq"
    files = {f"{cpu}/scaling_governor": f"{governor}\n", f"{cpu}/scaling_driver": f"{driver}\n"}
    findings = power.diagnose(power.collect(machine(tmp_path, files), str))
    assert bad(findings) == ([("power.governor", "warn")] if warned else [])
    assert f"CPU governor {governor}" in text(findings, "power.governor")


@pytest.mark.parametrize(
    ("facts", "verdict"),
    [
        (GroupFacts(pi=False, mine=()), []),
        (GroupFacts(pi=True, uid=0), []),
        (GroupFacts(pi=True, mine=("audio", "dialout", "video", "users")), []),
        (GroupFacts(pi=True, mine=("audio", "video")), [("groups", "warn")]),
        (GroupFacts(pi=True, mine=("audio",), existing=("audio",)), []),
    ],
)
def test_groups_of_the_robots_user(facts: GroupFacts, verdict: list[tuple[str, str]]) -> None:
    assert bad(groups.diagnose(facts)) == verdict


def test_the_mend_names_the_groups_that_are_missing() -> None:
    facts = GroupFacts(pi=True, user="maria", mine=("video",))
    said = text(groups.diagnose(facts), "groups")
    assert "you are not in: dialout, audio" in said
    assert "sudo usermod -aG dialout,audio maria" in said
    joined = GroupFacts(pi=True, mine=("video",), written=("dialout", "audio"))
    assert "log out and in again" in text(groups.diagnose(joined), "groups")
    assert "usermod" not in text(groups.diagnose(joined), "groups")


def test_groups_of_this_machine_can_be_read(tmp_path: Path) -> None:
    facts = groups.collect(machine(tmp_path, {"proc/device-tree/model": PI}))
    assert facts.pi
    assert set(facts.existing) <= set(groups.NEEDED)
    assert facts.user


def test_ports_are_told_with_what_they_look_like(monkeypatch: pytest.MonkeyPatch) -> None:
    there = [
        SerialPort("/dev/ttyACM0", "/dev/serial/by-id/usb-MicroPython", "2e8a:0005", "Board"),
        SerialPort("/dev/ttyUSB0", "", "1a86:7523", ""),
        SerialPort("/dev/ttyACM1", "", "1234:5678", "Modem"),
    ]
    monkeypatch.setattr(serial_ports, "serial_ports", lambda: there)
    found = serial_ports.collect().ports
    assert [access.port for access in found] == there
    allowed = SerialFacts(tuple(Access(port) for port in there))
    assert [finding.text for finding in serial_ports.diagnose(allowed)] == [
        "serial port /dev/serial/by-id/usb-MicroPython (Board, Pico with MicroPython)",
        "serial port /dev/ttyUSB0 (CH340 bridge: a sonar, or the servos)",
        "serial port /dev/ttyACM1 (Modem)",
    ]
