"""The number of a killed participant is nobody's any more, and there is an end to keeping them."""

from __future__ import annotations

import socket
from pathlib import Path

import pytest

from launcher.processes.ports import BlockedPorts


def free_ports(count: int) -> list[int]:
    sockets = [socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(count)]
    for each in sockets:
        each.bind(("", 0))
    ports = [int(each.getsockname()[1]) for each in sockets]
    for each in sockets:
        each.close()
    return ports


def is_free(port: int) -> bool:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as tried:
        try:
            tried.bind(("", port))
        except OSError:
            return False
        return True


def test_nobody_else_gets_the_port_for_discovery_before_one_that_is_kept() -> None:
    blocked, (port, taken) = BlockedPorts(), free_ports(2)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        other.bind(("", taken))
        blocked.keep([taken + 1, port + 1])
    assert not is_free(port)
    assert is_free(taken)


def free_domain() -> int:
    """A domain of whose first ports nobody has any."""
    for domain in range(102, 232):
        if all(is_free(7400 + 250 * domain + number) for number in range(10, 18)):
            return domain
    pytest.fail("there is no free domain on this machine")


def test_nobody_gets_a_number_whose_shared_memory_is_another_users(tmp_path: Path) -> None:
    blocked, domain = BlockedPorts(tmp_path), free_domain()
    first = 7400 + 250 * domain + 10
    # As who may not open it: not even root opens a folder so.
    (tmp_path / f"sem.fastrtps_port{first + 1}_mutex").mkdir()
    (tmp_path / f"fastrtps_port{first + 3}").touch()
    (tmp_path / f"fastrtps_port{first + 5}").mkdir()
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        other.bind(("", first))
        blocked.avoid_others(domain)
    assert [is_free(first + number) for number in range(6)] == [True] * 4 + [False, True]
    blocked.avoid_others(domain)
    assert [is_free(first + number) for number in range(6)] == [False] + [True] * 3 + [False, True]


def test_the_oldest_are_let_go(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("launcher.processes.ports._MOST", 2)
    blocked, ports = BlockedPorts(), free_ports(3)
    for port in ports:
        blocked.keep([port + 1])
    assert [is_free(port) for port in ports] == [True, False, False]


def test_ports_that_no_number_belongs_to_are_left_alone() -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        for port in range(6900, 7000):
            try:
                other.bind(("", port))
            except OSError:
                continue
            break
        port = other.getsockname()[1]
    BlockedPorts().keep([port, port + 1])
    assert is_free(port)
