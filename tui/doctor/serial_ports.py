"""Serial ports: which there are, by which lasting name, and whether they may be opened."""

from __future__ import annotations

import grp
import os
from dataclasses import dataclass
from typing import TYPE_CHECKING

from launcher.serial_ports import serial_ports
from tui.doctor.finding import ok, warn
from tui.i18n import _, said

if TYPE_CHECKING:
    from tui.doctor.finding import Finding


@dataclass(frozen=True)
class SerialPort:
    """One port."""

    device: str
    """`/dev/ttyACM0`."""
    description: str = ""
    by_id: str = ""
    """The name that stays the same at every plugging, empty if there is none."""
    group: str = ""
    allowed: bool = True
    """Whether this user may read and write it."""
    kind: str = ""
    """What it looks like by its USB ids, empty if they tell nothing."""


@dataclass(frozen=True)
class SerialFacts:
    """What is there."""

    ports: tuple[SerialPort, ...] = ()
    user: str = ""
    groups: tuple[str, ...] = ()
    """Of this process: a group joined a moment ago counts only after logging in again."""
    error: str = ""


def look() -> SerialFacts:
    """Find out; ports of the motherboard without anything behind them are left out."""
    try:
        found = serial_ports()
    except ImportError as error:
        return SerialFacts(error=str(error))
    ports = tuple(
        SerialPort(
            device=port.device,
            description=port.description,
            by_id=port.name,
            group=_group_of(port.device),
            allowed=os.access(port.device, os.R_OK | os.W_OK),
            kind=port.kind,
        )
        for port in found
    )
    return SerialFacts(ports, os.environ.get("USER", ""), tuple(map(_name, os.getgroups())))


def judge(facts: SerialFacts) -> list[Finding]:
    """Say what is well and what is not."""
    if facts.error:
        return [warn("serial", facts.error, "pip install pyserial")]
    if not facts.ports:
        return [ok("serial", _("no serial port; mocks need none"))]
    return [_port(port, facts) for port in facts.ports]


def permission_mend(device: str) -> str:
    """Return how this user comes to be allowed to open a device."""
    groups = tuple(map(_name, os.getgroups()))
    return _mend(_group_of(device), os.environ.get("USER", ""), groups)


def _mend(group: str, user: str, groups: tuple[str, ...]) -> str:
    user, group = user or "$USER", group or "dialout"
    if group in groups:
        mend = _("the group {group} is yours, but the port forbids it: look at its udev rule")
        return mend.format(group=group)
    mend = _("run: sudo usermod -aG {group} {user}, then log out and in again")
    return mend.format(group=group, user=user)


def _port(port: SerialPort, facts: SerialFacts) -> Finding:
    name = port.by_id or port.device
    what = ", ".join(part for part in (port.description, said(port.kind)) if part)
    text = _("serial port {name}").format(name=name) + (f" ({what})" if what else "")
    if port.allowed:
        return ok("serial", text)
    text = _("{what}: no permission").format(what=text)
    return warn("serial", text, _mend(port.group, facts.user, facts.groups))


def _group_of(device: str) -> str:
    try:
        return _name(os.stat(device).st_gid)  # noqa: PTH116 - a device, not a file to be read
    except OSError:
        return ""


def _name(gid: int) -> str:
    try:
        return grp.getgrgid(gid).gr_name
    except KeyError:
        return str(gid)
