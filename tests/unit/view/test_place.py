"""Where a viewer opens, and how it is reached."""

from __future__ import annotations

import socket

import pytest

from view.faults import PortTakenError
from view.place import HERE, Place, free_port, has_window, is_free, ssh_command

OVER_SSH = {"SSH_CONNECTION": "192.168.1.7 51234 192.168.1.20 22"}


@pytest.mark.parametrize(
    ("environ", "window"),
    [
        ({}, False),
        ({"DISPLAY": ":0"}, True),
        ({"WAYLAND_DISPLAY": "wayland-0"}, True),
        ({"DISPLAY": ""}, False),
        ({"DISPLAY": "localhost:10.0", **OVER_SSH}, False),
    ],
)
def test_a_window_opens_only_before_the_user(environ: dict[str, str], window: bool) -> None:
    assert has_window(environ) is window


def test_the_command_forwards_each_port_to_this_machine(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("getpass.getuser", lambda: "pi")
    command = ssh_command((9090, 9876), OVER_SSH)
    assert command == ("ssh -N -L 9090:127.0.0.1:9090 -L 9876:127.0.0.1:9876 pi@192.168.1.20")
    other = {"SSH_CONNECTION": "192.168.1.7 51234 192.168.1.20 2222"}
    assert ssh_command((1,), other).endswith(" -p 2222 pi@192.168.1.20")


@pytest.mark.parametrize("said", ["", "nonsense"])
def test_without_ssh_there_is_no_command(said: str) -> None:
    assert ssh_command((9090,), {"SSH_CONNECTION": said}) == ""


def test_a_port_that_was_asked_for_has_to_be_free() -> None:
    with socket.create_server((HERE, 0)) as taken:
        port = taken.getsockname()[1]
        assert not is_free(port)
        with pytest.raises(PortTakenError, match=f"port {port} is taken"):
            free_port(9090, port)
        assert free_port(port) != port


def test_the_page_is_told_where_its_data_are() -> None:
    place = Place(data_port=9876, page_port=9090)
    assert place.url == "http://127.0.0.1:9090"
    assert place.query.startswith("url=rerun%2Bhttp%3A%2F%2F127.0.0.1%3A9876%2Fproxy&")
