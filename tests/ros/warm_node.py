"""A node in a process forked from one that has rclpy and its messages already, as Deck forks it.

Saved is the start of Python and the imports, most of what the start of a node costs. What Python
reads when it starts (PYTHON..., permissions) has no effect here: see `NodeProcess`.
"""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

from launcher import node_program
from launcher.spawn_server.node import check_fields, renew_streams
from tests.forks import Forked, enter

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence


class WarmNode(Forked):
    """Such a process."""

    def __init__(self, argv: Sequence[str], *, cwd: str, env: Mapping[str, str], log: int) -> None:
        """Run a module with its arguments; what it prints goes to the descriptor `log`."""
        output = f"/proc/{os.getpid()}/fd/{log}"
        super().__init__(argv, _become, tuple(argv), cwd, dict(env), output)


def _become(argv: tuple[str, ...], cwd: str, env: dict[str, str], output: str) -> None:
    from tests.ros import warm_imports

    os.setsid()
    opened = os.open(output, os.O_WRONLY | os.O_APPEND)
    for stream in (1, 2):
        os.dup2(opened, stream)
    os.close(opened)
    enter(cwd, env)
    renew_streams()
    node_program.prepare(argv)
    warm_imports.SHARED.renew(argv[0])
    check_fields(env["ROS_PYTHON_CHECK_FIELDS"])
    node_program.run(argv[0])
