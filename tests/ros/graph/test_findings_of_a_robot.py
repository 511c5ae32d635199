"""A healthy robot has no findings, while it starts and ends either."""

from __future__ import annotations

import signal
from typing import TYPE_CHECKING

import pytest

from graph.findings.rules import LastingFindings
from tests.deck_process import DeckProcess
from tests.ros.observing import Watcher
from tests.waiting import wait_until
from tui.session.bypass import NORMS

if TYPE_CHECKING:
    from collections.abc import Callable

pytestmark = pytest.mark.nightly

LASTS_S = 6.0
"""By then, what is missing among nodes that all run is told."""


@pytest.mark.parametrize(("profile", "nodes"), [("robot", 15), ("06-rviz", 4)])
def test_a_healthy_robot_has_none_while_it_starts_either(watcher: Watcher, profile: str, nodes: int) -> None:
    """Whatever is missing for a moment while fifteen nodes start and end is not told."""
    watcher.want(all_topics=True)
    lasting, told = LastingFindings(NORMS), set[str]()
    run = DeckProcess("run", profile)

    def watched(until: Callable[[], bool]) -> Callable[[], bool]:
        """Look for findings with each look at the condition."""

        def look() -> bool:
            update = watcher.update
            lasting.take(update, update.time_s)
            # On a busy machine messages are really lost.
            found = (one for one in lasting.told(update.time_s) if one.rule != "lost")
            told.update(f"{one.key}: {one.what}" for one in found)
            return until()

        return look

    try:
        wait_until(watched(lambda: len(watcher.update.nodes) >= nodes), "all of its nodes")
        all_s = watcher.update.time_s
        wait_until(watched(lambda: watcher.update.time_s > all_s + LASTS_S), "a calm while")
        run.signal(signal.SIGINT)
        wait_until(watched(lambda: run.process.poll() is not None), "its end")
    finally:
        run.close()
    assert told == set()
