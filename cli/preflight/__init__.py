"""`deck check --preflight`: whether each device is found, permitted, free, and answering.

Nothing moves: `cli.preflight.answers` says what is sent. Only `command` is used elsewhere.
"""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from functools import partial
from typing import TYPE_CHECKING

from cli.doctor.finding import Finding
from cli.preflight.media import ask_camera, ask_sound
from cli.preflight.ports import ask_ports
from launcher.serial_ports import serial_ports

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from cli.preflight.open_port import DeviceAnswer
    from launcher.profile.load import Profile
    from launcher.serial_ports import SerialPort

MEDIA = {"camera": ask_camera, "sound": ask_sound}
"""Kinds of device without a serial port."""


def examine(profile: Profile, find_ports: Callable[[], Sequence[SerialPort]] = serial_ports) -> list[Finding]:
    """Check all devices that the profile's nodes refer to, in parallel."""
    said = profile.devices
    devices = {name: said[name] for name in profile.used if name in said}
    questions: dict[str, Callable[[], tuple[str, DeviceAnswer]]] = {
        **ask_ports(devices, find_ports),
        **{
            name: partial(MEDIA[settings["kind"]], name, settings)
            for name, settings in devices.items()
            if settings.get("kind") in MEDIA
        },
    }
    if not questions:
        return []
    with ThreadPoolExecutor(len(questions)) as pool:
        answers = {name: pool.submit(question) for name, question in questions.items()}
        return [_finding(name, *answers[name].result()) for name in devices if name in answers]


def _finding(device: str, where: str, answer: DeviceAnswer) -> Finding:
    name = f"{device} {where}".rstrip()
    return Finding(f"device.{device}", answer.level, f"{name}: {answer.text}", answer.fix)
