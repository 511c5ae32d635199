"""A session whose run directory goes is still reached, and is not started a second time."""

from __future__ import annotations

import shutil
import stat
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from launcher.client.client import attach
from launcher.rundir import run_dir
from tests.ros.supervised import SLEEPER, Launch, running_pid
from tests.waiting import until

if TYPE_CHECKING:
    from launcher.client.client import SupervisorClient

pytestmark = pytest.mark.nightly

NODE = {"node": {"exec": SLEEPER}}


def home(client: SupervisorClient) -> Path:
    return run_dir() / client.session.run_id


async def made_again(client: SupervisorClient) -> Path:
    """Wait until the folder of the session is where it belongs, with all that is in it."""
    folder = home(client)

    def complete() -> bool:
        return (folder / "session.json").is_file() and (folder / "control.sock").is_socket()

    await until(complete, "the folder of the session")
    return folder


@pytest.mark.parametrize("what", ["the whole directory", "the session's folder", "the socket"])
async def test_what_is_removed_is_made_again_and_told(start: Launch, tmp_path: Path, what: str) -> None:
    client = await start(NODE)
    pid = await running_pid(client, "node")
    if what == "the socket":
        (home(client) / "control.sock").unlink()
    else:
        shutil.rmtree(tmp_path / "run" if what == "the whole directory" else home(client))
    folder = await made_again(client)
    assert stat.S_IMODE(folder.stat().st_mode) == 0o700
    assert stat.S_IMODE((folder / "control.sock").stat().st_mode) == 0o600
    other = await attach("test")
    assert other.nodes["node"].pid == pid
    assert any("is gone" in line.text for line in await other.history(None, 100))
    await other.aclose()
