"""The supervisor: starts a session's nodes, watches them, and ends them.

`python -m launcher.supervisor PACKAGE... ROOM` is started by `launcher.client.client.launch`; it
may be told beforehand the packages that its nodes will be from. Its plan comes as one line on
stdin, which then stays open as long as the client lives: in the foreground, its end is the
end of the session. It answers with one line on stdout: where to connect, or why not.
"""

from __future__ import annotations

import os
import sys

from launcher.processes.prctl import become_subreaper
from launcher.run_id import new_run_id
from launcher.spawn_server.start import fork_spawn_server
from launcher.supervisor.guardian import fork_under_guardian


def main() -> None:
    """Run one session."""
    # It waits for the answer to its plan; the parent will be the guardian.
    client = os.getppid()
    fork_under_guardian()
    become_subreaper()
    run_id = new_run_id()
    # First of all: what it imports takes longer than all that is done here meanwhile.
    spawn_server = fork_spawn_server(run_id, sys.argv[1:-1])

    import asyncio

    from launcher.supervisor.run import run

    asyncio.run(run(run_id, spawn_server, client))


if __name__ == "__main__":
    main()
