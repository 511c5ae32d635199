"""The relay of pictures: in sessions that other machines may see, as long as they run."""

from __future__ import annotations

import json
import signal
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from launcher.client.client import launch
from launcher.processes.table import processes
from tests.ros.supervised import SLEEPER, alive, kill
from tests.waiting import until

if TYPE_CHECKING:
    from launcher.client.client import SupervisorClient

pytestmark = pytest.mark.nightly

RELAY = b"relay"
WITHIN_S = 40.0


def relay_of(client: SupervisorClient) -> int | None:
    """Return the number of its process."""
    for process in processes():
        if process.parent == client.session.supervisor_pid and not process.zombie:
            title = Path(f"/proc/{process.pid}/cmdline").read_bytes()
            if RELAY in title:
                return process.pid
    return None


async def test_it_runs_with_the_session_and_comes_back(tmp_path: Path, ros_domain: int) -> None:
    path = tmp_path / "networked.yaml"
    nodes = {"sleeper": {"exec": SLEEPER}}
    path.write_text(
        json.dumps({"title": {"en": "T"}, "discovery": ["127.0.0.1"], "nodes": nodes}), "utf-8"
    )
    client = await launch(path, domain=ros_domain)
    try:
        first = await until(lambda: relay_of(client), "the relay", WITHIN_S)
        kill(first, signal.SIGKILL)
        await until(lambda: not alive(first), "its end", WITHIN_S)
        second = await until(lambda: relay_of(client), "another relay", WITHIN_S)
    finally:
        await client.shutdown(now=True)
    await until(lambda: not alive(second), "its end with the session", WITHIN_S)
