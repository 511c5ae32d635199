"""The command line: words of both languages, a warning before an unknown one, history."""

from __future__ import annotations

import pytest
from textual import on
from textual.app import App, ComposeResult
from textual.widgets import Static

from text.i18n import set_language
from tui.deck.command_line import CommandLine, WordSuggester


class LineApp(App[None]):
    """A bare app with the line, which notes what is sent."""

    def __init__(self) -> None:
        super().__init__()
        self.sent: list[str] = []

    def compose(self) -> ComposeResult:
        yield CommandLine()

    @on(CommandLine.CommandSent)
    def _note(self, event: CommandLine.CommandSent) -> None:
        self.sent.append(event.text)

    @property
    def line(self) -> CommandLine:
        return self.query_one(CommandLine)

    @property
    def remark(self) -> str:
        return str(self.line.query_one(Static).content)


async def test_enter_sends_the_word_and_empties_the_line() -> None:
    app = LineApp()
    async with app.run_test() as pilot:
        await pilot.press(*"left", "enter")
        assert app.sent == ["left"]
        assert app.line.field.value == ""
        await pilot.press("space", "enter", "enter")
        assert app.sent == ["left"]


async def test_an_unknown_word_is_warned_of_and_sent_all_the_same() -> None:
    app = LineApp()
    async with app.run_test() as pilot:
        app.line.show_listeners(1)
        await pilot.press(*"прыжок")
        assert "unknown word “прыжок”" in app.remark
        await pilot.press("enter")
        assert app.sent == ["прыжок"]


@pytest.mark.parametrize(
    ("language", "start", "whole"),
    [
        ("ru", "на", "налево"),
        ("ru", "ВПЕРЁ", "ВПЕРЁд"),
        ("ru", "st", "stop"),
        ("en", "f", "forward"),
        ("en", "вп", "вперед"),
        ("en", "прыж", None),
        ("en", "", None),
    ],
)
async def test_words_of_both_languages_are_completed(language: str, start: str, whole: str | None) -> None:
    set_language(language)
    assert await WordSuggester().get_suggestion(start) == whole


async def test_up_and_down_recall_and_keep_the_draft() -> None:
    app = LineApp()
    async with app.run_test() as pilot:
        for word in ("left", "left", "back"):
            await pilot.press(*word, "enter")
        await pilot.press(*"ri")
        values = []
        for key in ("up", "up", "up", "down", "down", "down"):
            await pilot.press(key)
            values.append(app.line.field.value)
        assert values == ["back", "left", "left", "back", "ri", "ri"]
