"""Checking camera and sound of the real robot, in separate processes: drivers hang and crash.

A camera has to deliver one picture; for sound only the names of the devices are checked, and
nothing is recorded or played.
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from cli.child_python import python
from cli.doctor.finding import Level
from cli.doctor.serial_ports import permission_fix
from cli.preflight.open_port import DeviceAnswer, holders
from launcher.profile.serial_choice import variable
from text.i18n import _
from text.nested import read_json

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

WITHIN_S = 12.0
OFF = "none"
"""The value that means "no device" to the sound node."""
PICTURE = """
import sys, cv2
name = sys.argv[1]
how = cv2.CAP_V4L2 if name.startswith("/dev/") else cv2.CAP_FFMPEG
well, picture = cv2.VideoCapture(name, how).read()
if well:
    print("%dx%d" % (picture.shape[1], picture.shape[0]))
"""
SOUND = Path(__file__).resolve().parents[2] / "nodes" / "drivers" / "sound_device.py"
"""Lists the devices as the node of the sound knows them; run, never imported."""


def ask_camera(device: str, settings: Mapping[str, Any]) -> tuple[str, DeviceAnswer]:
    """Get a picture from a camera; return its name and the result."""
    source = str(settings.get("source", "0"))
    name = f"/dev/video{int(source)}" if source.isdecimal() else source
    if "://" in name:
        return _("a stream"), _picture(name)
    path = Path(name).expanduser()
    if not path.exists():
        there = ", ".join(map(str, sorted(Path("/dev").glob("video[0-9]*")))) or _("none")
        text = _("there is no such camera; cameras: {cameras}").format(cameras=there)
        fix = _("plug it in, or choose with {variable}=/dev/v4l/by-id/...")
        return name, DeviceAnswer(Level.FAIL, text, fix.format(variable=variable(device, "source")))
    if not os.access(path, os.R_OK):
        return name, DeviceAnswer(Level.FAIL, _("no permission"), permission_fix(str(path)))
    return name, _picture(str(path))


def _picture(name: str) -> DeviceAnswer:
    size = _run(python(PICTURE, name)).strip()
    if size:
        return DeviceAnswer(Level.OK, _("a picture of {size}").format(size=size))
    others = holders(name)
    if others:
        text = _("{names} has it open").format(names=", ".join(map(str, others)))
        return DeviceAnswer(Level.FAIL, text, _("close it; if it is a running robot: deck down"))
    fix = _("is it a video, and does it answer?")
    if name.startswith("/dev/"):
        fix = _("it may be another device of the same camera: v4l2-ctl --list-devices")
    return DeviceAnswer(Level.FAIL, _("it delivers no picture"), fix)


def ask_sound(device: str, settings: Mapping[str, Any]) -> tuple[str, DeviceAnswer]:
    """Look for microphone and loudspeaker."""
    wanted = [(setting, str(settings.get(setting, ""))) for setting in ("microphone", "speaker")]
    wanted = [(setting, name) for setting, name in wanted if name != OFF]
    if not wanted:
        return "", DeviceAnswer(Level.OK, _("switched off"))
    microphones, speakers = _sound_devices()
    found: list[str] = []
    missing: list[tuple[str, str]] = []
    for setting, name in wanted:
        there = microphones if setting == "microphone" else speakers
        fitting = [each for at, each in enumerate(there) if _is(name, at, each)]
        if fitting:
            found.append(fitting[0])
        else:
            missing.append((setting, name))
    if not missing:
        return "", DeviceAnswer(Level.OK, ", ".join(dict.fromkeys(found)))
    return "", _no_sound(device, missing, list(dict.fromkeys([*microphones, *speakers])))


def _sound_devices() -> tuple[Sequence[str], Sequence[str]]:
    """Return the names of the microphones and of the loudspeakers."""
    try:
        microphones, speakers = read_json(_run([sys.executable, str(SOUND), "list"]))
    except ValueError:
        return (), ()
    return microphones, speakers


def _no_sound(device: str, missing: Sequence[tuple[str, str]], there: Sequence[str]) -> DeviceAnswer:
    titles = {"microphone": _("microphone"), "speaker": _("loudspeaker")}
    wishes = [f"{titles[setting]} {name}".rstrip() for setting, name in missing]
    text = _("not found: {missing}; sound devices: {names}").format(
        missing=", ".join(wishes), names=", ".join(there) or _("none")
    )
    fix = _("plug it in, or set {variables} to a part of its name; `none` works without")
    variables = ", ".join(variable(device, setting) for setting, _name in missing)
    return DeviceAnswer(Level.FAIL, text, fix.format(variables=variables))


def _is(wanted: str, index: int, name: str) -> bool:
    if wanted.isdecimal():
        return int(wanted) == index
    return wanted.casefold() in name.casefold()


def _run(command: Sequence[str]) -> str:
    """Return what a program prints, nothing if it fails or takes too long."""
    try:
        done = subprocess.run(
            command, capture_output=True, text=True, errors="replace", timeout=WITHIN_S, check=False
        )
    except (OSError, subprocess.TimeoutExpired):
        return ""
    return done.stdout if done.returncode == 0 else ""
