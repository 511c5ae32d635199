"""The emergency stop on disk: one small file per domain, from the stop until its release.

Every node that obeys the stop writes it, and reads it at its start, so that a stop outlives its
sender, every node, and a power failure. The file is written atomically, through a temporary file
beside it. An unreadable file counts as a stop: when in doubt nothing moves.
"""

from __future__ import annotations

import contextlib
import json
import os
import time
from pathlib import Path
from typing import NamedTuple

from robot.safety.stop_place import stop_place
from text.os_words import os_reason

_LONGEST = 4096


class KeptStop(NamedTuple):
    """An emergency stop that is in effect."""

    since_s: float
    """Unix time."""
    by: str
    """What engaged it: `topic` or `pico`."""
    publishers: str = ""
    """Full names of the nodes that could have sent it on the topic, separated by blanks."""
    remembered: bool = False
    """Whether it comes from before the start of this node."""
    unreadable: str = ""
    """Why nothing more is known about it."""


class StopMemory:
    """The saved stop of one domain."""

    def __init__(self, domain: int, writer: str) -> None:
        """`writer` is the full name of the node."""
        self._domain = domain
        self._draft = f".{domain}{writer.replace('/', '.')}"

    def recall(self) -> KeptStop | None:
        """Return the saved stop, None if there is none."""
        try:
            with self._place().open("rb") as file:
                text = file.read(_LONGEST)
        except (FileNotFoundError, RuntimeError):
            return None
        except OSError as error:
            return _unreadable(os_reason(error))
        return _read(text)

    def keep(self, stop: KeptStop) -> str:
        """Save it, unless a stop is saved already; return why that failed."""
        document = {"since": stop.since_s, "by": stop.by, "publishers": stop.publishers}
        try:
            place = self._place()
            folder = place.parent
            if os.path.lexists(place):
                return ""
            folder.mkdir(mode=0o700, parents=True, exist_ok=True)
            _write(folder / self._draft, json.dumps(document).encode())
            (folder / self._draft).replace(place)
            _flush(folder)
        except (OSError, RuntimeError) as error:
            return os_reason(error)
        return ""

    def _place(self) -> Path:
        return stop_place(self._domain)

    def forget(self) -> str:
        """Remove the saved stop; return why that failed."""
        try:
            place = self._place()
            with contextlib.suppress(FileNotFoundError):
                place.unlink()
                _flush(place.parent)
        except (OSError, RuntimeError) as error:
            return os_reason(error)
        return ""


def _read(text: bytes) -> KeptStop:
    try:
        document = json.loads(text)
        return KeptStop(
            float(document["since"]),
            str(document["by"]),
            str(document.get("publishers", "")),
            remembered=True,
        )
    except (ValueError, TypeError, KeyError, AttributeError, RecursionError) as error:
        return _unreadable(os_reason(error))


def _unreadable(reason: str) -> KeptStop:
    return KeptStop(time.time(), "", remembered=True, unreadable=reason)


def _write(path: Path, data: bytes) -> None:
    flags = os.O_WRONLY | os.O_CREAT | os.O_TRUNC | os.O_NOFOLLOW | os.O_CLOEXEC
    with os.fdopen(os.open(path, flags, 0o600), "wb") as file:
        file.write(data)
        file.flush()
        os.fsync(file.fileno())


def _flush(folder: Path) -> None:
    """Flush it to disk: the power may fail at any moment."""
    descriptor = os.open(folder, os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
