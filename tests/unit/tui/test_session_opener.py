"""What is made ready while a person reads the list of lessons."""

from __future__ import annotations

import os
import subprocess
import sys

from launcher.status import SessionInfo
from tui.lifecycle.opener import LiveOpener

OPENED = """
import asyncio, sys
from tui.lifecycle.opener import LiveOpener

async def main():
    opener = LiveOpener()
    opener._start_ahead = lambda: asyncio.sleep(0)
    await opener.prepare()
    before = set(sys.modules)
    import tui.deck.screen
    from tui.panels.registry import PANELS, make_panel
    for name in PANELS:
        make_panel(name)
    print(sorted(set(sys.modules) - before))

asyncio.run(main())
"""


def test_a_lesson_that_is_chosen_from_the_list_has_its_screen_imported_by_then() -> None:
    done = subprocess.run(
        [sys.executable, "-c", OPENED], capture_output=True, text=True, check=True
    )
    assert done.stdout.strip() == "[]"


def test_whoever_looks_on_changes_no_setting_of_what_is_started_later() -> None:
    before = dict(os.environ)
    LiveOpener().observe(SessionInfo("run", "", "lesson", discovery="localhost"))
    assert dict(os.environ) == before
