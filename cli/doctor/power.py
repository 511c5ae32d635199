"""Supply and speed of the computer: low voltage on a Raspberry Pi, and a CPU that saves power."""

from __future__ import annotations

import subprocess
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from cli.doctor.finding import ok, warn
from text.i18n import _

if TYPE_CHECKING:
    from collections.abc import Callable

    from cli.doctor.finding import Finding

ROOT = Path("/")
LOW, LOW_BEFORE = 1 << 0, 1 << 16
HOT, HOT_BEFORE = 0b1110, 0b1110 << 16
"""Bits of `vcgencmd get_throttled`: capped, throttled or at the soft limit of the temperature."""
ASK_WITHIN_S = 3.0
ADAPTS = ("intel_pstate", "amd-pstate", "amd-pstate-epp")
"""Drivers whose `powersave` goes up to full speed when there is work."""


@dataclass(frozen=True)
class PowerFacts:
    """Supply and speed as the system reports them."""

    pi: str = ""
    """Model of the Raspberry Pi, empty if it is none."""
    throttled: int | None = None
    """Bits of `vcgencmd get_throttled`, None if that cannot be told."""
    governor: str = ""
    """Of the CPU's frequency, empty if there is none."""
    driver: str = ""
    """That the governor works with."""


def ask_firmware() -> str:
    """Return what a Raspberry Pi says of its supply, empty if it cannot be asked."""
    command = ["vcgencmd", "get_throttled"]
    try:
        done = subprocess.run(
            command, capture_output=True, text=True, timeout=ASK_WITHIN_S, check=False
        )
    except (OSError, subprocess.TimeoutExpired):
        return ""
    return done.stdout


def look(root: Path = ROOT, ask: Callable[[], str] = ask_firmware) -> PowerFacts:
    """Find out."""
    model = _text(root / "proc/device-tree/model").strip("\0 \n")
    pi = model if model.startswith("Raspberry Pi") else ""
    cpu = root / "sys/devices/system/cpu/cpu0/cpufreq"
    return PowerFacts(
        pi=pi,
        throttled=_throttled(ask(), root) if pi else None,
        governor=_text(cpu / "scaling_governor").strip(),
        driver=_text(cpu / "scaling_driver").strip(),
    )


def judge(facts: PowerFacts) -> list[Finding]:
    """Say what is well and what is not; nothing of what there is not."""
    found = []
    if facts.pi and facts.throttled is not None:
        found += _supply(facts.pi, facts.throttled)
    if facts.governor:
        found.append(_governor(facts))
    return found


def _supply(pi: str, bits: int) -> list[Finding]:
    found = []
    if bits & (LOW | LOW_BEFORE):
        text = _("low voltage now") if bits & LOW else _("low voltage since the start")
        mend = _("a supply of 5 V and 5 A with its own cable, away from that of the motors")
        found.append(warn("power.voltage", f"{pi}: {text}", mend))
    if bits & (HOT | HOT_BEFORE):
        text = _("slowed down now") if bits & HOT else _("slowed down since the start")
        mend = _("cool it: a fan, room around it; look again with vcgencmd measure_temp")
        found.append(warn("power.throttled", f"{pi}: {text}", mend))
    return found or [ok("power.voltage", _("{pi}: supply and temperature are well").format(pi=pi))]


def _governor(facts: PowerFacts) -> Finding:
    text = _("CPU governor {name}").format(name=facts.governor)
    if facts.governor != "powersave" or facts.driver in ADAPTS:
        return ok("power.governor", text)
    mend = _("echo ondemand | sudo tee /sys/devices/system/cpu/cpu*/cpufreq/scaling_governor")
    text = _("{text}: the CPU stays slow, and commands come late").format(text=text)
    return warn("power.governor", text, mend)


def _throttled(answer: str, root: Path) -> int | None:
    """Return the bits of `throttled=0x50005`; without it what the kernel's own sensor says."""
    _name, equals, bits = answer.strip().partition("=")
    try:
        return int(bits, 16) if equals else _sensed(root)
    except ValueError:
        return _sensed(root)


def _sensed(root: Path) -> int | None:
    for sensor in root.glob("sys/class/hwmon/hwmon*"):
        if _text(sensor / "name").strip() == "rpi_volt":
            return LOW if _text(sensor / "in0_lcrit_alarm").strip() == "1" else 0
    return None


def _text(path: Path) -> str:
    try:
        return path.read_text(errors="replace")
    except OSError:
        return ""
