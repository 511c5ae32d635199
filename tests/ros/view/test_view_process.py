"""The viewer that a screen opens: a process of its own, which does not outlive the screen."""

from __future__ import annotations

import subprocess
import sys

import psutil
import pytest

from tests.deck_process import alive
from tests.waiting import wait_until

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
def _no_display(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)


def family(pid: int) -> list[int]:
    """Return the numbers of a process and of all that it has started."""
    own = psutil.Process(pid)
    return [pid, *(child.pid for child in own.children(recursive=True))]


def test_it_does_not_outlive_a_screen_that_is_killed(ros_domain: int) -> None:
    command = [sys.executable, "-c", OPEN_FOREVER, str(ros_domain)]
    screen = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    assert screen.stdout is not None
    with screen.stdout:
        pid = int(screen.stdout.readline())
    processes = family(pid)
    screen.kill()
    screen.wait()
    wait_until(lambda: not any(map(alive, processes)), "the end of all of them")
