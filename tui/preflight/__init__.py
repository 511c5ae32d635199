"""`deck check --preflight`: each device of a profile found, permitted, free, and answering.

Nothing moves by it: what is sent is told in `tui.preflight.answers`.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing
from typing import TYPE_CHECKING, Any

from launcher.profile_devices import wanted
from launcher.serial_choice import AUTO, Unclear, choose
from launcher.serial_ports import serial_ports
from tui.doctor.finding import Finding, Level
from tui.i18n import _, said
from tui.preflight.answers import Answer, ask
from tui.preflight.opening import advice, opened

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from launcher.profile import Profile
    from launcher.serial_ports import SerialPort

Settings = Mapping[str, Any]
BAUD = 115_200


def examine(
    profile: Profile, look: Callable[[], Sequence[SerialPort]] = serial_ports
) -> list[Finding]:
    """Look at every device that the profile's nodes name, all at the same time."""
    devices = {name: profile.devices[name] for name in profile.used if name in profile.devices}
    serial = wanted(devices)
    if not serial:
        return []
    ports = look()
    chosen = choose(serial, ports)
    paths = {
        device: devices[device]["port"] if one is None or isinstance(one, Unclear) else one.path
        for device in serial
        for one in (chosen.get(device),)
    }
    with ThreadPoolExecutor(len(serial)) as pool:
        answers = {
            device: pool.submit(_one, device, devices[device], paths, chosen.get(device), ports)
            for device in serial
        }
        return [_finding(device, paths[device], each.result()) for device, each in answers.items()]


def _one(
    device: str,
    settings: Settings,
    paths: Mapping[str, str],
    chosen: SerialPort | Unclear | None,
    ports: Sequence[SerialPort],
) -> Answer:
    if isinstance(chosen, Unclear):
        return Answer(Level.FAIL, str(said(chosen.message)), str(said(chosen.hint)))
    path = paths[device]
    twins = [
        other
        for other, its in paths.items()
        if other != device and its != AUTO and os.path.realpath(its) == os.path.realpath(path)
    ]
    if twins:
        text = _("the same port as {others}").format(others=", ".join(twins))
        mend = _("give each device its own port; ls -l /dev/serial/by-id tells which is which")
        return Answer(Level.FAIL, text, mend)
    baud = settings.get("baud", BAUD)
    line = opened(device, path, baud if isinstance(baud, int) else BAUD, ports)
    if isinstance(line, Answer):
        return line
    with closing(line):
        try:
            answer = ask(str(settings.get("kind", "")), line)
        except OSError as error:
            mend = _("look at the cable and at the supply")
            return Answer(Level.FAIL, _("it went while asked: {error}").format(error=error), mend)
    lasting = advice(path)
    if answer.level is Level.OK and lasting:
        text = _("{text}; its name may be another device's after the next plugging")
        mend = _("write {path}").format(path=lasting)
        return Answer(Level.WARN, text.format(text=answer.text), mend)
    return answer


def _finding(device: str, path: str, answer: Answer) -> Finding:
    where = device if path == AUTO else f"{device} {path}"
    return Finding(f"device.{device}", answer.level, f"{where}: {answer.text}", answer.mend)
