"""`python -m tests.ros.owner PROFILE DOMAIN MODE`: starts a session and waits, as a screen does.

Prints `{"session": ..., "pids": {...}}` once every node runs.
"""

from __future__ import annotations

import asyncio
import json
import signal
import sys
from dataclasses import asdict

from launcher.client.client import launch


async def main(profile: str, domain: str, mode: str) -> None:
    client = await launch(profile, domain=int(domain), foreground=mode == "foreground")
    async for _event in client.events():
        pids = {name: node.pid for name, node in client.nodes.items()}
        if all(pids.values()):
            print(json.dumps({"session": asdict(client.session), "pids": pids}), flush=True)  # noqa: T201
            break
    async for _event in client.events():
        pass


if __name__ == "__main__":
    # Under nohup it would be ignored.
    signal.signal(signal.SIGHUP, signal.SIG_DFL)
    asyncio.run(main(*sys.argv[1:]))
