"""Power supply and CPU speed: low voltage on a Raspberry Pi, and power-saving governors."""

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
"""Bits of `vcgencmd get_throttled`: capped, throttled, or at the soft temperature limit."""
ASK_WITHIN_S = 3.0
ADAPTS = ("intel_pstate", "amd-pstate", "amd-pstate-epp")
"""Drivers whose `powersave` still goes up to full speed under load."""


@dataclass(frozen=True)
class PowerFacts:
    """Supply and speed as the system reports them."""

    pi: str = ""
    """Model of the Raspberry Pi, empty on other machines."""
    throttled: int | None = None
    """Bits of `vcgencmd get_throttled`, None if not available."""
    governor: str = ""
    """The governor of the CPU frequency, empty if there is none."""
    driver: str = ""
    """The frequency driver that the governor works with."""


def ask_firmware() -> str:
    """Return a Raspberry Pi's report on its supply, empty if it cannot be asked."""
    command = ["vcgencmd", "get_throttled"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=ASK_WITHIN_S, check=False)
    except (OSError, subprocess.TimeoutExpired):
        return ""
    return done.stdout


def collect(root: Path = ROOT, ask: Callable[[], str] = ask_firmware) -> PowerFacts:
    model = _text(root / "proc/device-tree/model").strip("\0 \n")
    pi = model if model.startswith("Raspberry Pi") else ""
    cpu = root / "sys/devices/system/cpu/cpu0/cpufreq"
    return PowerFacts(
        pi=pi,
        throttled=_throttled(ask(), root) if pi else None,
        governor=_text(cpu / "scaling_governor").strip(),
        driver=_text(cpu / "scaling_driver").strip(),
    )


def diagnose(facts: PowerFacts) -> list[Finding]:
    """Report what is all right and what is not; nothing about parts that do not exist."""
    found = []
    if facts.pi and facts.throttled is not None:
        found += _supply(facts.pi, facts.throttled)
    if facts.governor:
        found.append(_governor(facts))
    return found


def _supply(pi: str, bits: int) -> list[Finding]:
    found = []
    if bits & (LOW | LOW_BEFORE):
        text = _("low voltage now") if bits & LOW else _("low voltage since power-on")
        fix = _("use a 5 V, 5 A supply with its own cable, separate from the motors'")
        found.append(warn("power.voltage", f"{pi}: {text}", fix))
    if bits & (HOT | HOT_BEFORE):
        text = _("slowed down now") if bits & HOT else _("slowed down since power-on")
        fix = _("cool it: a fan, space around it; check with vcgencmd measure_temp")
        found.append(warn("power.throttled", f"{pi}: {text}", fix))
    return found or [ok("power.voltage", _("{pi}: power supply and temperature are fine").format(pi=pi))]


def _governor(facts: PowerFacts) -> Finding:
    text = _("CPU governor {name}").format(name=facts.governor)
    if facts.governor != "powersave" or facts.driver in ADAPTS:
        return ok("power.governor", text)
    fix = _("echo ondemand | sudo tee /sys/devices/system/cpu/cpu*/cpufreq/scaling_governor")
    text = _("{text}: the CPU stays slow, and commands arrive late").format(text=text)
    return warn("power.governor", text, fix)


def _throttled(answer: str, root: Path) -> int | None:
    """Return the bits of `throttled=0x50005`; without it, the state of the kernel's own sensor."""
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
