"""The port of a device, opened for a check: bytes in and out with deadlines, or why it cannot be opened."""

from __future__ import annotations

import contextlib
import errno
import os
import termios
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

import serial

from cli.doctor.checks import permission_fix
from cli.doctor.finding import Finding, fail, ok
from launcher.profile.serial_choice import how_to_choose
from launcher.serial_ports import SerialPort
from text.i18n import _, localized
from text.sentences import reason_of

PROC = Path("/proc")
MASTERS = ("/dev/ptmx", "/dev/pts/ptmx")


def good(text: str) -> Finding:
    return ok("", text)


def bad(text: str, fix: str) -> Finding:
    return fail("", text, fix)


class Holder(NamedTuple):
    """A program that has the device open."""

    pid: int
    name: str

    def __str__(self) -> str:
        """Name it in the form in which a user would look for it."""
        return f"{self.name} (pid {self.pid})"


def holders(device: str, proc: Path = PROC) -> list[Holder]:
    """Return the other processes that have it open, by pid.

    The creator of a pseudo-terminal holds both of its ends and does not block it.
    """
    wanted, found = os.path.realpath(device), []
    for folder in proc.glob("[0-9]*"):
        files: set[str] = set()
        with contextlib.suppress(OSError):  # A process of another user, or one that has ended.
            for descriptor in (folder / "fd").iterdir():
                with contextlib.suppress(OSError):  # Closed in the meantime.
                    files.add(str(descriptor.readlink()))
        own = int(folder.name) == os.getpid()
        if not own and wanted in files and not (wanted.startswith("/dev/pts/") and files & set(MASTERS)):
            found.append(Holder(int(folder.name), _name(folder)))
    return sorted(found)


def _name(folder: Path) -> str:
    """Return the name of the process; for a Python node, its title."""
    with contextlib.suppress(OSError):
        words = (folder / "cmdline").read_bytes().split(b"\0")
        name = os.path.basename(words[0].decode(errors="replace"))  # noqa: PTH119
        return name or (folder / "comm").read_text(errors="replace").strip()
    return "?"


BAD = (OSError, termios.error, serial.SerialException, TypeError)
"""The exceptions that pyserial raises when a cable is unplugged."""
_READ_S, _WRITE_S = 0.05, 0.3
_MOST = 4096


class OpenPort:
    """An open port; must be closed."""

    def __init__(self, path: str, baud: int) -> None:
        """Open it exclusively.

        Raises:
            OSError, ValueError: if that is not possible.
        """
        self.baud = baud
        self._port = serial.Serial(path, baud, timeout=_READ_S, write_timeout=_WRITE_S, exclusive=True)

    def close(self) -> None:
        with contextlib.suppress(*BAD):
            self._port.close()

    def hear(self, seconds: float, enough: Callable[[bytes], bool]) -> bytes:
        """Return the data of so many seconds; sooner if `enough` is true for a piece of it.

        Raises:
            OSError: if the device disappears.
        """
        end_s, heard = time.monotonic() + seconds, b""
        try:
            while time.monotonic() < end_s:
                data = self._port.read(1)
                data += self._port.read(min(self._port.in_waiting, _MOST))
                heard += data
                if data and enough(data):
                    break
        except (termios.error, TypeError) as error:
            raise OSError(str(error)) from error
        return heard

    def say(self, data: bytes) -> None:
        """Send data, whether or not it is received.

        Raises:
            OSError: if the device disappears.
        """
        try:
            with contextlib.suppress(serial.SerialTimeoutException):
                self._port.write(data)
        except (termios.error, TypeError) as error:
            raise OSError(str(error)) from error


TAKEN = (errno.EAGAIN, errno.EBUSY)
DENIED = (errno.EACCES, errno.EPERM)
GONE = (errno.ENOENT, errno.ENXIO, errno.ENODEV)


def opened(
    device: str, path: str, baud: int, ports: Sequence[SerialPort], opening: Callable[[str, int], OpenPort] = OpenPort
) -> OpenPort | Finding:
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
        return held(path, others)
    return line


def _refused(device: str, path: str, error: Exception, ports: Sequence[SerialPort]) -> Finding:
    number = _number(error)
    if number in TAKEN:
        return held(path, holders(path))
    if number in DENIED:
        return bad(_("no permission"), permission_fix(path))
    if number in GONE:
        return _missing(device, path, ports)
    if number in (errno.ENOTTY, errno.EINVAL, errno.EISDIR):
        return bad(_("it is not a serial port"), str(localized(how_to_choose(device))))
    words = reason_of(error).splitlines()[0]
    fix = _("unplug the device, plug it in again, and look at: dmesg | tail")
    return bad(_("cannot be opened: {reason}").format(reason=words), fix)


def _missing(device: str, path: str, ports: Sequence[SerialPort]) -> Finding:
    dangling = os.path.islink(path)  # noqa: PTH114 - a device, not a file
    text = _("it is gone, only its name is left") if dangling else _("there is no such port")
    there = "; ".join(map(str, ports)) or _("none")
    text = _("{text}; ports: {ports}").format(text=text, ports=there)
    fix = _("plug it in, try another cable; or {choose}")
    return bad(text, fix.format(choose=localized(how_to_choose(device))))


def held(path: str, others: Sequence[Holder]) -> Finding:
    """Return that other programs have a device open, or that some unknown one has."""
    if not others:
        fix = _("close that program; sudo fuser -v {path} shows which it is").format(path=path)
        return bad(_("another program is using it"), fix)
    fix = _("close it; if it is a running robot: deck down")
    return bad(_("{names} has it open").format(names=", ".join(map(str, others))), fix)


def _number(error: Exception) -> int | None:
    cause = error.__context__ if isinstance(error.__context__, termios.error) else error
    number = cause.args[0] if cause.args else None
    return number if isinstance(number, int) else None
