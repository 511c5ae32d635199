"""What styles cost: a screen is styled once, and again only when that can change its look."""

from __future__ import annotations

import pytest
from textual.app import App
from textual.dom import DOMNode

from tests.tui.app_runs import opened
from tui.frame.key_bar import KeyBar


async def test_a_screen_that_comes_back_is_styled_anew_only_after_the_theme_has_changed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    async with opened() as (app, pilot):
        deck, styled = app.screen, []

        def noted(node: DOMNode, animate: bool = True) -> None:
            styled.append(node)
            App.update_styles(app, node, animate)

        monkeypatch.setattr(app, "update_styles", noted)
        await pilot.press("2", "1")
        await pilot.pause()
        assert app.screen is deck
        assert deck not in styled
        before = deck.query_one(KeyBar).styles.background
        await pilot.press("2")
        app.theme = "textual-light"
        await pilot.press("1")
        await pilot.pause()
        assert deck in styled
        assert deck.query_one(KeyBar).styles.background != before
