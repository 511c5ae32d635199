"""Whose port it is: two views that start at once must not take each other's for their own."""

from __future__ import annotations

import os
import socket

from view.viewer import listened_at


def test_only_the_ports_of_the_process_itself_count() -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = server.getsockname()[1]
        assert port in listened_at(os.getpid())
        assert port not in listened_at(os.getppid())
    assert port not in listened_at(os.getpid())
