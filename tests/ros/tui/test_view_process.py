"""The viewer that a screen opens: a process of its own, which does not outlive the screen."""

from __future__ import annotations

import asyncio
import os
import signal
import socket
import subprocess
import sys
from pathlib import Path
from urllib.request import urlopen

import psutil
import pytest

from tests.deck_process import alive
from tests.waiting import until, wait_until
from tui.viewing.process import NotOpenedError, start_view
from view.own_folder import PREFIX, OwnFolder

pytestmark = pytest.mark.nightly

OPEN_FOREVER = """
import asyncio, sys
from tui.viewing.process import start_view
async def main():
    view = await start_view(int(sys.argv[1]))
    print(view._process.pid, flush=True)
    await asyncio.sleep(600)
asyncio.run(main())
"""


@pytest.fixture(autouse=True)
def folders(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    """Where temporary folders are made."""
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    return tmp_path


@pytest.fixture(autouse=True)
def _no_display(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)


def family(pid: int) -> list[int]:
    """Return the numbers of a process and of all that it has started."""
    own = psutil.Process(pid)
    return [pid, *(child.pid for child in own.children(recursive=True))]


def kept_in(place: Path) -> list[Path]:
    """Return the folders of viewers in a place."""
    return list(place.glob(f"{PREFIX}*"))


async def test_it_opens_a_page_and_ends_when_told(
    ros_domain: int, monkeypatch: pytest.MonkeyPatch, folders: Path
) -> None:
    monkeypatch.setenv("SSH_CONNECTION", "10.0.0.7 50000 10.0.0.20 22")
    view = await start_view(ros_domain)
    try:
        pid = view._process.pid
        await until(lambda: len(family(pid)) == 3, "itself, Rerun and the observer")
        processes = family(pid)
        forwarded = " ".join(f"-L {port}:127.0.0.1:{port}" for port in view.opened.ports)
        assert view.opened.ssh.startswith(f"ssh -N {forwarded} ")
        page = await asyncio.to_thread(lambda: urlopen(view.opened.url).read())
        assert page
        assert len(kept_in(folders)) == 1
    finally:
        await view.end()
    assert view.ended
    assert await view.fault() == ""
    await until(lambda: not any(map(alive, processes)), "its end")
    assert kept_in(folders) == []


def test_it_does_not_outlive_a_screen_that_is_killed(ros_domain: int, folders: Path) -> None:
    command = [sys.executable, "-c", OPEN_FOREVER, str(ros_domain)]
    screen = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    assert screen.stdout is not None
    with screen.stdout:
        pid = int(screen.stdout.readline())
    processes = family(pid)
    screen.kill()
    screen.wait()
    wait_until(lambda: not any(map(alive, processes)), "the end of all of them")
    assert kept_in(folders) == []


async def test_rerun_dies_with_a_process_that_is_killed(ros_domain: int, folders: Path) -> None:
    view = await start_view(ros_domain)
    processes = family(view._process.pid)
    os.kill(view._process.pid, signal.SIGKILL)
    await until(lambda: not any(map(alive, processes)), "the end of both")
    await until(lambda: view.ended, "the word of it")
    # Of what it has left the next one removes all.
    OwnFolder().close()
    assert kept_in(folders) == []


async def test_what_keeps_it_from_opening_is_said(ros_domain: int) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        with pytest.raises(NotOpenedError, match=f"port {port} is taken"):
            await start_view(ros_domain, ("--port", str(port)))
