"""Who is there for `ros2`, and packages that are elsewhere."""

from __future__ import annotations

import os
import struct

import pytest

from graph.participants import Attendance
from launcher.domain.participants import LocalParticipant
from ros2 import presence
from ros2.presence import Missing, missing, words

HERE, THERE = b"\x01\x0f\x10\x10", b"\x01\x0f\x20\x20"
OTHER_MAKE = b"\x01\x10\x10\x10"
US = os.getpid()


def guid(pid: int, host: bytes = HERE, number: int = 0) -> bytes:
    return host + struct.pack("<HHI", pid & 0xFFFF, 7, number)


def local(*pids: int) -> list[LocalParticipant]:
    return [LocalParticipant(7411 + 2 * n, pid) for n, pid in enumerate((US, *pids))]


def found(*guids: bytes, partly: tuple[bytes, ...] = ()) -> Attendance:
    return Attendance(frozenset((guid(US), *guids, *partly)), frozenset(partly))


@pytest.mark.parametrize(
    ("attendance", "here", "who"),
    [
        (found(), local(), Missing()),
        (found(), [], Missing()),
        (found(), local(4_000_000), Missing((4_000_000,))),
        (found(guid(4_000_000)), local(4_000_000), Missing()),
        (found(partly=(guid(5),)), local(5), Missing((5,))),
        # Two participants of one process, of which one is found.
        (found(guid(5)), local(5, 5), Missing((5,))),
        (found(guid(5), guid(5, number=1)), local(5, 5), Missing()),
        # Another user's, whose process cannot be known: it counts by number.
        (found(), local(0), Missing((0,))),
        (found(guid(77)), local(0), Missing()),
        (found(guid(77, OTHER_MAKE)), local(9), Missing()),
        # Of other machines there is only their own word.
        (found(guid(5, THERE)), local(5), Missing((5,))),
        (found(partly=(guid(5, THERE),)), local(), Missing((), 1)),
        # It has left since: the kernel knows it no more.
        (found(partly=(guid(5),)), local(), Missing()),
        # Nothing is known where the kernel shows no ports.
        (found(partly=(guid(5),)), [], Missing((0,))),
    ],
)
def test_who_is_missing(attendance: Attendance, here: list[LocalParticipant], who: Missing) -> None:
    assert missing(attendance, here) == who


def test_it_is_said_who(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(presence, "command_line", lambda pid: f"python3 n{pid}.py")
    monkeypatch.setattr(presence, "read_environment", lambda *_: "")
    far = 10**9
    assert words(Missing((far, far + 1, far + 2, far + 3, 0), 2), 7) == (
        "this may not be all: nothing, or not everything, has been heard in domain 7 from "
        "python3 n1000000000.py (pid 1000000000), python3 n1000000001.py (pid 1000000001), "
        "python3 n1000000002.py (pid 1000000002), 1 more, 1 of other users or containers, "
        "2 on other machines"
    )
