"""The supervisor: starts a session's nodes, monitors them, and ends them.

`python -m launcher.supervisor ROOM` is started by `launcher.client.client.launch`. It reads its plan as one line from
stdin, which then stays open as long as the client lives: a foreground session ends when it is
closed. It answers with one line on stdout: where to connect, or why it cannot run.
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
    # The client waits for the answer to its plan; the parent will become the guardian.
    client = os.getppid()
    fork_under_guardian()
    become_subreaper()
    run_id = new_run_id()
    # This comes first: its imports take longer than everything done here in the meantime.
    spawn_server = fork_spawn_server(run_id)

    # asyncio does without it where there is none; nobody here speaks TLS, for which it takes 1.4 MB.
    sys.modules["ssl"] = None  # type: ignore[assignment]
    import asyncio

    del sys.modules["ssl"]

    from launcher.supervisor.run import run

    asyncio.run(run(run_id, spawn_server, client))


if __name__ == "__main__":
    main()
