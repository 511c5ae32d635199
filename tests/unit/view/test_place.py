"""Where the viewer opens."""

from __future__ import annotations

import pytest

from view.place import ssh_command

OVER_SSH = {"SSH_CONNECTION": "192.168.1.7 51234 192.168.1.20 22"}


def test_the_command_forwards_each_port_to_this_machine(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("getpass.getuser", lambda: "pi")
    command = ssh_command((9090, 9876), OVER_SSH)
    assert command == ("ssh -N -L 9090:127.0.0.1:9090 -L 9876:127.0.0.1:9876 pi@192.168.1.20")
    other = {"SSH_CONNECTION": "192.168.1.7 51234 192.168.1.20 2222"}
    assert ssh_command((1,), other).endswith(" -p 2222 pi@192.168.1.20")
