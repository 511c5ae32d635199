"""What is made ready while a person reads the list of lessons."""

from __future__ import annotations

import subprocess
import sys

OPENED = """
import asyncio, sys
from tui.launchpad import LivePad

async def main():
    pad = LivePad()
    pad._start_ahead = lambda: asyncio.sleep(0)
    await pad.prepare()
    before = set(sys.modules)
    import tui.screens.deck
    from tui.panels.made import PANELS, make_panel
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
