"""Changing tabs for hours leaves nothing behind: no widget, timer, task, style or line more."""

from __future__ import annotations

import asyncio
import gc
from collections import Counter
from typing import TYPE_CHECKING, Any

import pytest
from textual.css.styles import RenderStyles, StylesBase
from textual.dom import DOMNode
from textual.message import Message
from textual.signal import Signal
from textual.strip import Strip
from textual.timer import Timer

from tests.tui.app_runs import opened
from tests.tui.recorded import RecordedOpener

if TYPE_CHECKING:
    from textual.pilot import Pilot

pytestmark = pytest.mark.nightly

TABS = ("f2", "f3", "f4", "f5", "L", "5", "6", "7", "8", "9")
KINDS = (DOMNode, Timer, asyncio.Task, StylesBase, RenderStyles, Message, Signal, Strip)


@pytest.mark.timeout(300)
async def test_changing_tabs_leaves_nothing_behind() -> None:
    opener = RecordedOpener()
    async with opened(opener) as (_app, pilot):
        await change_tabs(pilot, opener, rounds=2)
        before = living()
        await change_tabs(pilot, opener, rounds=2)
        assert living() - before == Counter()


async def change_tabs(pilot: Pilot[Any], opener: RecordedOpener, rounds: int) -> None:
    """Show each screen in turn, each with new data, and end at the first."""
    update = opener.graph.update
    assert update is not None
    for _round in range(rounds):
        for tab in (*TABS, TABS[0]):
            await pilot.press(tab)
            opener.graph.show(update)
            await pilot.pause()


def living() -> Counter[str]:
    """Count what is reachable, by its kind; of the same screen it is always as much."""
    gc.collect()
    kinds = [kind for each in gc.get_objects() for kind in KINDS if isinstance(each, kind)]
    return Counter(kind.__name__ for kind in kinds)
