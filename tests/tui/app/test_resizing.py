"""A new size that arrives while a screen has none of its parts: as it opens, or as it is closed."""

from __future__ import annotations

import pytest
from textual.events import Resize
from textual.geometry import Size
from textual.widget import Widget

from tests.tui.app_runs import opened
from tests.tui.snapshots import settle


@pytest.mark.parametrize("name", ["deck", "devices", "frames"])
async def test_a_screen_without_its_parts_bears_it(name: str) -> None:
    async with opened(screen=name) as (app, pilot):
        await app.screen.query(Widget).remove()
        app.screen.post_message(Resize(Size(80, 24), Size(80, 24)))
        await settle(pilot)
