"""The number of a killed participant is nobody's any more, and there is an end to keeping them."""

from __future__ import annotations

import socket

import pytest

from launcher.process_ports import BurntPorts


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
    burnt, (port, taken) = BurntPorts(), free_ports(2)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        other.bind(("", taken))
        burnt.keep([taken + 1, port + 1])
    assert not is_free(port)
    assert is_free(taken)


def test_the_oldest_are_let_go(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("launcher.process_ports._MOST", 2)
    burnt, ports = BurntPorts(), free_ports(3)
    for port in ports:
        burnt.keep([port + 1])
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
    BurntPorts().keep([port, port + 1])
    assert is_free(port)
