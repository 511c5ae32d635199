"""Checking the serial devices of a profile: the port of each, and its answer there."""

from __future__ import annotations

import os
from contextlib import closing
from functools import partial
from typing import TYPE_CHECKING, Any

from cli.doctor.finding import Level
from cli.preflight.answers import ask
from cli.preflight.open_port import DeviceAnswer, advice, opened
from launcher.profile.devices import wanted
from launcher.profile.serial_choice import AUTO, UnresolvedPort, choose
from text.i18n import _, localized

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from launcher.serial_ports import SerialPort

BAUD = 115_200


def ask_ports(
    devices: Mapping[str, Mapping[str, Any]], find_ports: Callable[[], Sequence[SerialPort]]
) -> dict[str, Callable[[], tuple[str, DeviceAnswer]]]:
    """Return, for each device with a port, a function that checks it: port name and answer."""
    serial = wanted(devices)
    if not serial:
        return {}
    ports = find_ports()
    chosen = choose(serial, ports)
    paths: dict[str, str] = {}
    for device in serial:
        found = chosen.get(device)
        written = str(devices[device]["port"])
        paths[device] = written if found is None or isinstance(found, UnresolvedPort) else found.path
    return {device: partial(_ask, device, devices[device], paths, chosen.get(device), ports) for device in serial}


def _ask(
    device: str,
    settings: Mapping[str, Any],
    paths: Mapping[str, str],
    chosen: SerialPort | UnresolvedPort | None,
    ports: Sequence[SerialPort],
) -> tuple[str, DeviceAnswer]:
    if isinstance(chosen, UnresolvedPort):
        return "", DeviceAnswer(Level.FAIL, str(localized(chosen.message)), str(localized(chosen.hint)))
    return paths[device], _one(device, settings, paths, ports)


def _one(
    device: str, settings: Mapping[str, Any], paths: Mapping[str, str], ports: Sequence[SerialPort]
) -> DeviceAnswer:
    path = paths[device]
    twins = [
        other
        for other, its in paths.items()
        if other != device and its != AUTO and os.path.realpath(its) == os.path.realpath(path)
    ]
    if twins:
        text = _("the same port as {others}").format(others=", ".join(twins))
        fix = _("give each device its own port; ls -l /dev/serial/by-id shows which is which")
        return DeviceAnswer(Level.FAIL, text, fix)
    baud = settings.get("baud", BAUD)
    line = opened(device, path, baud if isinstance(baud, int) else BAUD, ports)
    if isinstance(line, DeviceAnswer):
        return line
    with closing(line):
        try:
            answer = ask(str(settings.get("kind", "")), line)
        except OSError as error:
            fix = _("check the cable and the power supply")
            return DeviceAnswer(Level.FAIL, _("it disappeared during the check: {error}").format(error=error), fix)
    lasting = advice(path)
    if answer.level is Level.OK and lasting:
        text = _("{text}; its name may belong to another device after it is plugged in again")
        fix = _("write {path}").format(path=lasting)
        return DeviceAnswer(Level.WARN, text.format(text=answer.text), fix)
    return answer
