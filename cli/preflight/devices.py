"""`deck check --preflight`: whether each real device is found, permitted, free, and answers; nothing moves.

A serial device is asked at its port, see `cli.preflight.answers`. A camera has to deliver one picture; for sound
only the names of the devices are checked, and nothing is recorded or played. Both in processes of their own, as
drivers hang and crash.
"""

from __future__ import annotations

import os
import subprocess
import sys
from argparse import Namespace
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any, TypeAlias

from cli.doctor.checks import child_python, permission_fix
from cli.doctor.command import show
from cli.doctor.finding import Finding, Level, warn
from cli.preflight.answers import ask
from cli.preflight.open_port import bad, good, held, holders, opened
from launcher.errors import UsageError
from launcher.profile.catalog import find_profile
from launcher.profile.devices import wanted
from launcher.profile.load import load_profile
from launcher.profile.model import Profile
from launcher.profile.serial_choice import AUTO, UnresolvedPort, choose, variable
from launcher.serial_ports import SerialPort, lasting_names, serial_ports
from text.i18n import _, localized, ngettext
from text.nested import read_json
from text.output import Paint, json_text, write
from text.plain import plain
from text.sentences import say

Settings: TypeAlias = Mapping[str, Any]
Question: TypeAlias = Callable[[], tuple[str, Finding]]

BAUD = 115_200
WITHIN_S = 12.0
NOT_READY = 2
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


def preflight_command(options: Namespace) -> int:
    """Check every device of a profile; return 2 if one of them is not ready.

    Raises:
        UsageError: without a profile, or with mock hardware, whose devices exist only while it
            runs.
    """
    if not options.profile:
        raise UsageError(say("--preflight needs a profile: deck check robot --preflight"))
    if options.hardware != "real":
        raise UsageError(say("--preflight checks real devices: add --hardware real"))
    profile = load_profile(
        find_profile(options.profile), hardware=options.hardware, overrides=options.overrides, domain=options.domain
    )
    findings = examine(profile)
    bad = sum(finding.level is Level.FAIL for finding in findings)
    if options.json:
        write(json_text([finding.for_programs() for finding in findings], indent=2))
        return NOT_READY if bad else 0
    if not findings:
        write(_("{name} has no devices").format(name=plain(profile.name)))
        return 0
    show(findings, Paint(sys.stdout))
    if not bad:
        write(_("every device answers; nothing was moved"))
        return 0
    words = ngettext(
        "{count} device is not ready; nothing was moved", "{count} devices are not ready; nothing was moved", bad
    )
    write(words.format(count=bad))
    return NOT_READY


def examine(profile: Profile, find_ports: Callable[[], Sequence[SerialPort]] = serial_ports) -> list[Finding]:
    """Check all devices that the profile's nodes refer to, in parallel."""
    said = profile.devices
    devices = {name: said[name] for name in profile.used if name in said}
    media = {"camera": ask_camera, "sound": ask_sound}
    questions = ask_ports(devices, find_ports)
    for name, settings in devices.items():
        if settings.get("kind") in media:
            questions[name] = partial(media[settings["kind"]], name, settings)
    if not questions:
        return []
    with ThreadPoolExecutor(len(questions)) as pool:
        answers = {name: pool.submit(question) for name, question in questions.items()}
    found = []
    for device in (name for name in devices if name in answers):
        where, answer = answers[device].result()
        text = f"{device} {where}".rstrip() + f": {answer.text}"
        found.append(replace(answer, key=f"device.{device}", text=text))
    return found


def ask_ports(devices: Mapping[str, Settings], find_ports: Callable[[], Sequence[SerialPort]]) -> dict[str, Question]:
    """Return, for each device with a port, a function that checks it: port name and answer."""
    serial = wanted(devices)
    if not serial:
        return {}
    ports = find_ports()
    chosen = choose(serial, ports)
    questions: dict[str, Question] = {}
    paths: dict[str, str] = {}
    for device in serial:
        found = chosen.get(device)
        if isinstance(found, UnresolvedPort):
            paths[device] = str(devices[device]["port"])
            answer = bad(str(localized(found.message)), str(localized(found.hint)))
            questions[device] = partial(lambda answer: ("", answer), answer)
        else:
            paths[device] = str(devices[device]["port"]) if found is None else found.path
            questions[device] = partial(_ask_port, device, devices[device], paths, ports)
    return questions


def _ask_port(
    device: str, settings: Settings, paths: Mapping[str, str], ports: Sequence[SerialPort]
) -> tuple[str, Finding]:
    path = paths[device]
    twins = [
        other
        for other, its in paths.items()
        if other != device and its != AUTO and os.path.realpath(its) == os.path.realpath(path)
    ]
    if twins:
        fix = _("give each device its own port; ls -l /dev/serial/by-id shows which is which")
        return path, bad(_("the same port as {others}").format(others=", ".join(twins)), fix)
    baud = settings.get("baud", BAUD)
    line = opened(device, path, baud if isinstance(baud, int) else BAUD, ports)
    if isinstance(line, Finding):
        return path, line
    with closing(line):
        try:
            answer = ask(str(settings.get("kind", "")), line)
        except OSError as error:
            text = _("it disappeared during the check: {error}").format(error=error)
            return path, bad(text, _("check the cable and the power supply"))
    lasting = lasting_names().get(os.path.realpath(path), "") if path.startswith("/dev/tty") else ""
    if answer.level is Level.OK and lasting:
        text = _("{text}; its name may belong to another device after it is plugged in again")
        fix = _("write {path}").format(path=lasting)
        return path, warn("", text.format(text=answer.text), fix)
    return path, answer


def ask_camera(device: str, settings: Settings) -> tuple[str, Finding]:
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
        return name, bad(text, fix.format(variable=variable(device, "source")))
    if not os.access(path, os.R_OK):
        return name, bad(_("no permission"), permission_fix(str(path)))
    return name, _picture(str(path))


def _picture(name: str) -> Finding:
    size = _run(child_python(PICTURE, name)).strip()
    if size:
        return good(_("a picture of {size}").format(size=size))
    others = holders(name)
    if others:
        return held(name, others)
    fix = _("is it a video, and does it answer?")
    if name.startswith("/dev/"):
        fix = _("it may be another device of the same camera: v4l2-ctl --list-devices")
    return bad(_("it delivers no picture"), fix)


def ask_sound(device: str, settings: Settings) -> tuple[str, Finding]:
    titles = {"microphone": _("microphone"), "speaker": _("loudspeaker")}
    wanted = {setting: str(settings.get(setting, "")) for setting in titles}
    wanted = {setting: name for setting, name in wanted.items() if name != OFF}
    if not wanted:
        return "", good(_("switched off"))
    try:
        microphones, speakers = read_json(_run([sys.executable, str(SOUND), "list"]))
    except ValueError:
        microphones, speakers = [], []
    found, missing = [], []
    for setting, name in wanted.items():
        there = microphones if setting == "microphone" else speakers
        fitting = [each for at, each in enumerate(there) if _is(name, at, each)]
        (found.append(fitting[0]) if fitting else missing.append(setting))
    if not missing:
        return "", good(", ".join(dict.fromkeys(found)))
    wishes = ", ".join(f"{titles[setting]} {wanted[setting]}".rstrip() for setting in missing)
    names = ", ".join(dict.fromkeys([*microphones, *speakers])) or _("none")
    text = _("not found: {missing}; sound devices: {names}").format(missing=wishes, names=names)
    fix = _("plug it in, or set {variables} to a part of its name; `none` works without")
    return "", bad(text, fix.format(variables=", ".join(variable(device, setting) for setting in missing)))


def _is(wanted: str, index: int, name: str) -> bool:
    if wanted.isdecimal():
        return int(wanted) == index
    return wanted.casefold() in name.casefold()


def _run(command: Sequence[str]) -> str:
    try:
        done = subprocess.run(
            command, capture_output=True, text=True, errors="replace", timeout=WITHIN_S, check=False
        )
    except (OSError, subprocess.TimeoutExpired):
        return ""
    return done.stdout if done.returncode == 0 else ""
