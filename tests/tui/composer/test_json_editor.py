"""The editor of the LLM's JSON: its colours, its marks, and what it does not let through."""

from __future__ import annotations

import json
from collections.abc import Iterator

import pytest
from hypothesis import given
from hypothesis import strategies as st
from textual.app import App, ComposeResult
from textual.events import Paste

from robot.commands.schema import CommandError, parse_llm
from text.i18n import set_language
from tui.composer.json_editor import JsonEditor, tokens
from tui.composer.templates import TEMPLATES
from tui.composer.verdict import JsonVerdict
from tui.widgets.marked_editor import LONGEST_COLOURED, TextPlace, Token


class EditorApp(App[None]):
    """A bare app with an editor and a verdict."""

    def __init__(self) -> None:
        super().__init__()
        self.wanted: list[TextPlace] = []

    def on_json_verdict_problem_wanted(self, message: JsonVerdict.ProblemWanted) -> None:
        """Note which place was asked for."""
        self.wanted.append(message.place)

    def compose(self) -> ComposeResult:
        """One above the other."""
        yield JsonEditor('{\n  "speed": 5.0\n}\n')
        yield JsonVerdict()

    @property
    def editor(self) -> JsonEditor:
        """The editor."""
        return self.query_one(JsonEditor)

    def lines(self) -> list[str]:
        """What stands in the editor now."""
        return [self.editor.render_line(y).text.rstrip() for y in range(self.editor.size.height)]


def kinds(line: str) -> list[tuple[str, str]]:
    return [(line[token.start : token.end], token.kind) for token in tokens(line)]


def test_tokens_are_told_apart() -> None:
    assert kinds(r'  {"a\"b": [-1.5e3, true, "x:y"]}') == [
        ("{", "mark"), (r'"a\"b"', "key"), (":", "mark"), ("[", "mark"), ("-1.5e3", "number"),
        (",", "mark"), ("true", "word"), (",", "mark"), ('"x:y"', "string"), ("]", "mark"),
        ("}", "mark"),
    ]  # fmt: skip


@pytest.mark.parametrize("text", ["'a'", "NaN", "01", "1.", '"open', "вперёд", "+1", "Infinity"])
def test_what_json_does_not_know_is_bad(text: str) -> None:
    assert "bad" in {kind for _text, kind in kinds(text)}


@given(st.text())
def test_tokens_of_any_line_follow_each_other(line: str) -> None:
    end = 0
    for token in tokens(line):
        assert end <= token.start < token.end <= len(line)
        end = token.end


@pytest.mark.every_frame
async def test_the_line_of_the_cursor_keeps_its_colours() -> None:
    app = EditorApp()
    async with app.run_test() as pilot:

        def colours(y: int) -> set[object]:
            text = app.editor.render_line(y).crop(app.editor.gutter_width)
            return {segment.style.color for segment in text if segment.style}

        app.editor.move_cursor((0, 0))
        await pilot.pause()
        elsewhere = colours(1)
        app.editor.move_cursor((1, 0))
        await pilot.pause()
        assert elsewhere <= colours(1)
        (end,) = list(app.editor.render_line(1))[-1:]
        cursor_line = app.editor.get_component_styles("text-area--cursor-line").background
        assert end.style is not None
        assert end.style.bgcolor == (app.editor.background_colors[1] + cursor_line).rich_color


@pytest.mark.parametrize("language", ["en", "ru"])
def test_templates_are_what_their_titles_say(language: str) -> None:
    set_language(language)
    for template in TEMPLATES:
        if template.title.startswith("Wrong"):
            with pytest.raises(CommandError):
                parse_llm(template.text())
        else:
            assert parse_llm(template.text()).thought


async def test_a_line_with_a_problem_is_marked_and_its_value_underlined() -> None:
    app = EditorApp()
    async with app.run_test(size=(60, 12)) as pilot:
        app.editor.show_problems([TextPlace(2, 12)])
        await pilot.pause()
        assert app.lines()[1] == '2✗   "speed": 5.0'
        underlined = [
            segment.text
            for segment in app.editor.render_line(1)
            if segment.style is not None and segment.style.underline
        ]
        assert underlined == ["5.0"]
        app.editor.show_problems([])
        await pilot.pause()
        assert app.lines()[1] == '2    "speed": 5.0'


async def test_hostile_text_in_the_editor_is_harmless() -> None:
    app = EditorApp()
    async with app.run_test(size=(60, 12)) as pilot:
        app.editor.replace_all('{"a": "\x1b]52;c;QQ==\x07\x00[red]\u202e"}')
        await pilot.pause()
        assert app.lines()[0] == r'1  {"a": "\u001b]52;c;QQ==\u0007\u0000[red]\u202e"}'
        assert json.loads(app.editor.text) == {"a": "\x1b]52;c;QQ==\x07\x00[red]\u202e"}


async def test_another_text_can_be_undone() -> None:
    app = EditorApp()
    async with app.run_test(size=(60, 12)) as pilot:
        before = app.editor.text
        app.editor.replace_all("[]")
        await pilot.press("ctrl+z")
        assert app.editor.text == before


async def test_a_problem_in_the_list_leads_to_its_place() -> None:
    app = EditorApp()
    async with app.run_test(size=(60, 12)) as pilot:
        with pytest.raises(CommandError) as caught:
            parse_llm(
                '{"thought": "", "commands": [{"action": "drive",\n"speed": 5, "steering": 0}]}'
            )
        verdict = app.query_one(JsonVerdict)
        verdict.show(caught.value.problems, 0)
        await pilot.pause()
        verdict.query_one("OptionList").focus()
        await pilot.press("home", "enter")
        await pilot.pause()
        assert app.wanted == [TextPlace(2, 10)]


async def test_a_place_outside_of_the_text_is_survived() -> None:
    app = EditorApp()
    async with app.run_test(size=(60, 12)) as pilot:
        app.editor.show_problems([TextPlace(99, 99), TextPlace(0, 0)])
        app.editor.go_to(TextPlace(99, 99))
        await pilot.pause()
        assert app.editor.cursor_location == (3, 0)


async def test_a_megabyte_is_not_pasted() -> None:
    app = EditorApp()
    async with app.run_test(size=(60, 12)) as pilot:
        before = app.editor.text
        app.post_message(Paste("x" * 1_000_000))
        await pilot.pause()
        assert app.editor.text == before
        app.post_message(Paste("[1]"))
        await pilot.pause()
        assert app.editor.text == "[1]" + before


async def test_a_line_that_is_too_long_to_be_coloured_at_each_key_stays_plain(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    app, coloured = EditorApp(), []

    def noted(_editor: JsonEditor, line: str) -> Iterator[Token]:
        coloured.append(line)
        return tokens(line)

    monkeypatch.setattr(JsonEditor, "tokens_of", noted)
    async with app.run_test(size=(80, 24)) as pilot:
        app.editor.replace_all('{"thought":\n"' + '\\"x' * 20_000 + '", "commands": []}')
        app.editor.focus()
        await pilot.press("x")
        assert app.lines()[0].endswith('x{"thought":')
        assert set(coloured) >= {'x{"thought":'}
        assert max(map(len, coloured)) <= LONGEST_COLOURED
