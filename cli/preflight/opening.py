"""Opening the port of a device; why it cannot be opened, and how to fix that."""

from __future__ import annotations

import errno
import os
import termios
from typing import TYPE_CHECKING

from cli.doctor.finding import Level
from cli.doctor.serial_ports import permission_fix
from cli.preflight.answers import DeviceAnswer
from cli.preflight.holders import holders
from cli.preflight.open_port import OpenPort
from launcher.profile.serial_choice import how_to_choose
from launcher.serial_ports import lasting_names
from text.i18n import _, localized
from text.sentences import reason_of

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from cli.preflight.holders import Holder
    from launcher.serial_ports import SerialPort

TAKEN = (errno.EAGAIN, errno.EBUSY)
DENIED = (errno.EACCES, errno.EPERM)
GONE = (errno.ENOENT, errno.ENXIO, errno.ENODEV)


def opened(
    device: str, path: str, baud: int, ports: Sequence[SerialPort], opening: Callable[[str, int], OpenPort] = OpenPort
) -> OpenPort | DeviceAnswer:
    """Return the open port of a device, or why not; `ports` lists those that exist."""
    if not os.path.lexists(path):
        return _missing(device, path, ports)
    try:
        line = opening(path, baud)
    except (OSError, ValueError, termios.error) as error:
        return _refused(device, path, error, ports)
    others = holders(path)
    if others:
        line.close()
        return _taken(path, others)
    return line


def advice(path: str) -> str:
    """Return the permanent name to use instead of one that may change, if there is one."""
    if path.startswith("/dev/tty"):
        return lasting_names().get(os.path.realpath(path), "")
    return ""


def _refused(device: str, path: str, error: Exception, ports: Sequence[SerialPort]) -> DeviceAnswer:
    number = _number(error)
    if number in TAKEN:
        return _taken(path, holders(path))
    if number in DENIED:
        return DeviceAnswer(Level.FAIL, _("no permission"), permission_fix(path))
    if number in GONE:
        return _missing(device, path, ports)
    if number in (errno.ENOTTY, errno.EINVAL, errno.EISDIR):
        return DeviceAnswer(Level.FAIL, _("it is not a serial port"), str(localized(how_to_choose(device))))
    words = reason_of(error).splitlines()[0]
    fix = _("unplug the device, plug it in again, and look at: dmesg | tail")
    return DeviceAnswer(Level.FAIL, _("cannot be opened: {reason}").format(reason=words), fix)


def _missing(device: str, path: str, ports: Sequence[SerialPort]) -> DeviceAnswer:
    dangling = os.path.islink(path)  # noqa: PTH114 - a device, not a file
    text = _("it is gone, only its name is left") if dangling else _("there is no such port")
    there = "; ".join(map(str, ports)) or _("none")
    text = _("{text}; ports: {ports}").format(text=text, ports=there)
    fix = _("plug it in, try another cable; or {choose}")
    return DeviceAnswer(Level.FAIL, text, fix.format(choose=localized(how_to_choose(device))))


def _taken(path: str, others: Sequence[Holder]) -> DeviceAnswer:
    if not others:
        fix = _("close that program; sudo fuser -v {path} shows which it is").format(path=path)
        return DeviceAnswer(Level.FAIL, _("another program is using it"), fix)
    names = ", ".join(map(str, others))
    fix = _("close it; if it is a running robot: deck down")
    return DeviceAnswer(Level.FAIL, _("{names} has it open").format(names=names), fix)


def _number(error: Exception) -> int | None:
    cause = error.__context__ if isinstance(error.__context__, termios.error) else error
    number = cause.args[0] if cause.args else None
    return number if isinstance(number, int) else None
