"""Serial ports: which exist, under which permanent names, and whether they may be opened."""

from __future__ import annotations

import grp
import os
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

from cli.doctor.finding import ok, warn
from launcher.serial_ports import serial_ports
from text.i18n import _, localized

if TYPE_CHECKING:
    from cli.doctor.finding import Finding
    from launcher.serial_ports import SerialPort


class Access(NamedTuple):
    """One port and its permissions."""

    port: SerialPort
    group: str = ""
    allowed: bool = True
    """Whether this user may read and write it."""


@dataclass(frozen=True)
class SerialFacts:
    """The serial ports found."""

    ports: tuple[Access, ...] = ()
    user: str = ""
    groups: tuple[str, ...] = ()
    """Groups of this process: one joined recently only counts after logging in again."""
    error: str = ""


def collect() -> SerialFacts:
    """Gather the facts; leave out ports of the motherboard without a device behind them."""
    try:
        found = serial_ports()
    except ImportError as error:
        return SerialFacts(error=str(error))
    ports = tuple(Access(port, _group_of(port.device), os.access(port.device, os.R_OK | os.W_OK)) for port in found)
    return SerialFacts(ports, os.environ.get("USER", ""), tuple(map(_name, os.getgroups())))


def diagnose(facts: SerialFacts) -> list[Finding]:
    """Report what is all right and what is not."""
    if facts.error:
        return [warn("serial", facts.error, "pip install pyserial")]
    if not facts.ports:
        return [ok("serial", _("no serial port; mocks need none"))]
    return [_port(access, facts) for access in facts.ports]


def permission_fix(device: str) -> str:
    """Return how this user can get permission to open a device."""
    groups = tuple(map(_name, os.getgroups()))
    return _fix(_group_of(device), os.environ.get("USER", ""), groups)


def _fix(group: str, user: str, groups: tuple[str, ...]) -> str:
    user, group = user or "$USER", group or "dialout"
    if group in groups:
        fix = _("you are in group {group}, but the port denies access: check its udev rule")
        return fix.format(group=group)
    fix = _("run: sudo usermod -aG {group} {user}, then log out and in again")
    return fix.format(group=group, user=user)


def _port(access: Access, facts: SerialFacts) -> Finding:
    port = access.port
    what = ", ".join(part for part in (port.description, localized(port.kind)) if part)
    text = _("serial port {name}").format(name=port.path) + (f" ({what})" if what else "")
    if access.allowed:
        return ok("serial", text)
    text = _("{what}: no permission").format(what=text)
    return warn("serial", text, _fix(access.group, facts.user, facts.groups))


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
