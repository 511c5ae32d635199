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
        """The line."""
        yield CommandLine()

    @on(CommandLine.CommandSent)
    def _note(self, event: CommandLine.CommandSent) -> None:
        self.sent.append(event.text)

    @property
    def line(self) -> CommandLine:
        """The line."""
        return self.query_one(CommandLine)

    @property
    def remark(self) -> str:
        """What stands below the line."""
        return str(self.line.query_one(Static).content)


async def test_enter_sends_the_word_and_empties_the_line() -> None:
    app = LineApp()
    async with app.run_test() as pilot:
        await pilot.press(*"left", "enter")
        assert app.sent == ["left"]
        assert app.line.field.value == ""
        await pilot.press("space", "enter", "enter")
        assert app.sent == ["left"]


async def test_a_known_word_says_what_it_will_do() -> None:
    app = LineApp()
    async with app.run_test() as pilot:
        app.line.show_listeners(1)
        await pilot.press(*"Налево")
        assert app.remark == "0.3 m/s, steering 0.5 rad"


async def test_an_unknown_word_is_warned_of_and_sent_all_the_same() -> None:
    app = LineApp()
    async with app.run_test() as pilot:
        app.line.show_listeners(1)
        await pilot.press(*"прыжок")
        assert "unknown word “прыжок”" in app.remark
        await pilot.press("enter")
        assert app.sent == ["прыжок"]


async def test_it_says_when_nobody_listens() -> None:
    app = LineApp()
    async with app.run_test():
        app.line.show_listeners(0)
        assert "nobody listens to /ai_command" in app.remark
        app.line.show_listeners(2)
        assert "nobody" not in app.remark


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
async def test_words_of_both_languages_are_completed(
    language: str, start: str, whole: str | None
) -> None:
    set_language(language)
    assert await WordSuggester().get_suggestion(start) == whole


async def test_the_right_arrow_takes_the_suggestion() -> None:
    app = LineApp()
    async with app.run_test() as pilot:
        await pilot.press("f")
        await app.workers.wait_for_complete()
        await pilot.pause()
        await pilot.press("right", "enter")
        assert app.sent == ["forward"]


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
