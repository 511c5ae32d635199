"""Who has not told all: participants by the kernel's word, set against those who were found."""

from __future__ import annotations

import os
import socket
import struct

import pytest

from graph.participants.roll import Attendance
from launcher.domain.participants import LocalParticipant
from ros2 import presence
from ros2.presence import Missing, is_off, is_wide, missing, words

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


def test_where_others_may_be(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(socket, "if_nameindex", lambda: [(1, "lo"), (2, "eth0")])
    assert is_wide({})
    assert is_wide({"ROS_AUTOMATIC_DISCOVERY_RANGE": "subnet"})
    assert not is_wide({"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"})
    assert is_wide({"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST", "ROS_STATIC_PEERS": "10.0.0.2"})
    assert not is_wide({"ROS_LOCALHOST_ONLY": "1"})
    assert is_off({"ROS_AUTOMATIC_DISCOVERY_RANGE": "OFF"})
    assert not is_wide({"ROS_AUTOMATIC_DISCOVERY_RANGE": "OFF", "ROS_STATIC_PEERS": "10.0.0.2"})
    monkeypatch.setattr(socket, "if_nameindex", lambda: [(1, "lo")])
    assert not is_wide({})
