"""Who has ports of a ROS domain on this machine."""

from __future__ import annotations

import os
import pwd
import socket

from launcher.domain.ports import other_users, owners, read_socket

TABLE = [
    "  512: 0100007F:1CF2 00000000:0000 07 00000000:00000000 00:00000000 00000000  1000 0 7 2 0 0",
    "  513: 00000000:1CE8 00000000:0000 07 00000000:00000000 00:00000000 00000000  1001 0 8 2 0 0",
    "  514: 00000000:1DE2 00000000:0000 07 00000000:00000000 00:00000000 00000000  1002 0 9 2 0 0",
]


def test_ports_are_those_of_one_domain() -> None:
    sockets = list(map(read_socket, TABLE))
    assert owners(sockets, 0) == {1000, 1001}
    assert owners(sockets, 1) == {1002}
    assert owners(sockets, 2) == set()


def test_a_socket_of_somebody_elses_is_seen_by_its_owner(ros_domain: int) -> None:
    """Seen from another user, this process is somebody else."""
    first = 7400 + 250 * ros_domain
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as listening:
        listening.bind(("127.0.0.1", first + 249))
        somebody = os.getuid() + 1
        me = pwd.getpwuid(os.getuid()).pw_name
        assert me in other_users(ros_domain, us=somebody)
        assert me not in other_users(ros_domain)
