"""The participants of a domain on this machine, as the kernel shows them."""

from __future__ import annotations

import socket
from contextlib import ExitStack
from pathlib import Path

import pytest

from launcher.domain import participants
from launcher.domain.participants import LocalParticipant, LocalParticipants
from launcher.domain.ports import first_port


def listening(stack: ExitStack, port: int) -> socket.socket:
    made = stack.enter_context(socket.socket(socket.AF_INET, socket.SOCK_DGRAM))
    made.bind(("127.0.0.1", port))
    return made


def test_a_pair_of_ports_is_a_participant_and_a_single_one_is_not(ros_domain: int) -> None:
    first = first_port(ros_domain)
    with ExitStack() as stack:
        listening(stack, first + 20)
        listening(stack, first + 31)
        assert LocalParticipants(ros_domain).look() == []
        listening(stack, first + 21)
        assert LocalParticipants(ros_domain).look() == [LocalParticipant(first + 21)]


def test_a_pair_that_nobody_reads_was_left_behind(
    ros_domain: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    first = first_port(ros_domain)
    with ExitStack() as stack:
        discovery = listening(stack, first + 20)
        data = listening(stack, first + 21)
        there = LocalParticipants(ros_domain)
        data.sendto(b"x", discovery.getsockname())
        # Perhaps it only has no time for the moment.
        assert there.look() == [LocalParticipant(first + 21)]
        monkeypatch.setattr(participants, "UNREAD_S", 0.0)
        assert there.look() == []
        discovery.recv(1)
        assert there.look() == [LocalParticipant(first + 21)]


def test_a_lock_in_shared_memory_tells_the_process(
    ros_domain: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    first = first_port(ros_domain)
    lock = tmp_path / f"fastrtps_port{first + 21}_el"
    lock.touch()
    status = lock.stat()
    device = f"{status.st_dev >> 8 & 0xFFF:02x}:{status.st_dev & 0xFF:02x}"
    locks = tmp_path / "locks"
    locks.write_text(
        f"1: FLOCK  ADVISORY  WRITE 77 {device}:{status.st_ino} 0 EOF\n"
        "2: POSIX  ADVISORY  WRITE 78 08:01:5 0 EOF\n3: -> FLOCK\n"
    )
    monkeypatch.setattr(participants, "SHARED_MEMORY", tmp_path)
    monkeypatch.setattr(participants, "LOCKS", locks)
    # Through shared memory alone, without a UDP port.
    assert LocalParticipants(ros_domain).look() == [LocalParticipant(first + 21, 77)]
    with ExitStack() as stack:
        listening(stack, first + 20)
        listening(stack, first + 21)
        assert LocalParticipants(ros_domain).look() == [LocalParticipant(first + 21, 77)]
    locks.unlink()
    assert LocalParticipants(ros_domain).look() == []
