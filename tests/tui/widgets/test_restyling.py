"""What styles cost: a screen is styled once, and again only when that can change its look."""

from __future__ import annotations

import pytest
from rich.style import Style
from textual.app import App, ComposeResult
from textual.dom import DOMNode
from textual.strip import Strip
from textual.widget import Widget

from tests.tui.app_runs import opened
from tui.frame.key_bar import KeyBar
from tui.widgets.one_style import OneStyle


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


class Field(OneStyle, Widget):
    """Asks for its own style for every line."""

    def render_line(self, y: int) -> Strip:
        """A blank line."""
        del y
        return Strip.blank(self.size.width, self.rich_style)


class FieldApp(App[None]):
    """A bare app with nothing but the field."""

    def compose(self) -> ComposeResult:
        """The field fills the screen."""
        yield Field()


async def test_a_widget_works_out_its_style_once_for_all_its_lines_and_anew_for_the_next(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    async with FieldApp().run_test(size=(20, 10)) as pilot:
        field = pilot.app.query_one(Field)
        asked: list[Style] = []

        def style_of(_field: Widget) -> Style:
            asked.append(Style(italic=True))
            return asked[-1]

        monkeypatch.setattr(Widget, "rich_style", property(style_of))
        for colour in ("red", "blue"):
            asked.clear()
            field.styles.background = colour
            lines = field.render_lines(field.size.region)
            assert len(lines) == 10
            assert len(asked) == 1
