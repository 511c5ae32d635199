"""The editor of the LLM's JSON: its colours, its marks, and what it does not let through."""

from __future__ import annotations

import pytest
from textual.app import App, ComposeResult
from textual.events import Paste

from robot.commands.schema import CommandError, parse_llm
from text.i18n import set_language
from tui.composer.json_editor import JsonEditor, tokens
from tui.composer.templates import TEMPLATES
from tui.composer.verdict import JsonVerdict
from tui.widgets.marked_editor import TextPlace


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
