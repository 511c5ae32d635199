"""The form of YAML: its colours, its verdict, and what it hands over."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from textual.app import App, ComposeResult

from graph.messages.yaml_form import prefilled
from tests.waiting import until
from text.i18n import set_language
from tui.yaml_form import form as yaml_form
from tui.yaml_form.form import YamlForm
from tui.yaml_form.tokens import tokens

if TYPE_CHECKING:
    from textual.pilot import Pilot

DRIVE = "ackermann_msgs/msg/AckermannDriveStamped"


class FormApp(App[None]):
    """A bare app with a form."""

    def __init__(self, type_name: str) -> None:
        super().__init__()
        self.form = YamlForm(type_name)
        self.submitted: list[Any] = []

    def compose(self) -> ComposeResult:
        """Nothing but the form."""
        yield self.form

    def on_yaml_form_submitted(self, message: YamlForm.Submitted) -> None:
        """Note it."""
        self.submitted.append(message.value)

    def lines(self) -> list[str]:
        """What stands in the editor."""
        editor = self.form.editor
        return [editor.render_line(y).text.rstrip() for y in range(editor.size.height)]


async def checked(pilot: Pilot[Any]) -> None:
    """Wait until what stands in the form has been checked."""
    form = pilot.app.query_one(YamlForm)
    await until(lambda: form.text and form.text == form._checked, "a form that is checked")
    await pilot.pause()


def kinds(line: str) -> list[tuple[str, str]]:
    return [(line[token.start : token.end], token.kind) for token in tokens(line)]


def test_tokens_are_told_apart() -> None:
    assert kinds('- frame_id: "a # b"  # string') == [
        ("-", "mark"), ("frame_id", "key"), (":", "mark"), ('"a # b"', "string"),
        ("# string", "comment"),
    ]  # fmt: skip
    assert kinds("k: [1.5e3, -2, on, ~, a:b, .nan]") == [
        ("k", "key"), (":", "mark"), ("[", "mark"), ("1.5e3", "number"), (",", "mark"),
        ("-2", "number"), (",", "mark"), ("on", "word"), (",", "mark"), ("~", "word"),
        (",", "mark"), ("a:b", "string"), (",", "mark"), (".nan", "number"), ("]", "mark"),
    ]  # fmt: skip


@given(st.text())
def test_tokens_of_any_line_follow_each_other(line: str) -> None:
    end = 0
    for token in tokens(line):
        assert end <= token.start < token.end <= len(line)
        end = token.end


async def test_a_form_is_prefilled_and_right() -> None:
    app = FormApp(DRIVE)
    async with app.run_test(size=(80, 24)) as pilot:
        await checked(pilot)
        assert app.form.text.startswith("header:\n  stamp: now  # builtin_interfaces/Time\n")
        assert app.form.verdict == f"✓ valid {DRIVE}"
        value = app.form.value
        assert value is not None
        assert value["drive"]["speed"] == 0.0  # type: ignore[index,call-overload]


@pytest.mark.parametrize(
    ("language", "words"),
    [
        ("en", "✗ line 7: drive.speed: expected a number, got 'fast'"),
        ("ru", "✗ строка 7: drive.speed: нужно число, а здесь 'fast'"),
    ],
)
async def test_what_is_wrong_is_named_and_its_line_marked(language: str, words: str) -> None:
    set_language(language)
    app = FormApp(DRIVE)
    async with app.run_test(size=(80, 24)) as pilot:
        await checked(pilot)
        app.form.editor.replace_all(app.form.text.replace("speed: 0.0", "speed: fast"))
        await checked(pilot)
        assert app.form.verdict == words
        assert app.form.value is None
        assert "✗" in app.lines()[6]
        app.form.editor.replace_all(app.form.text.replace("speed: fast", "speed: 1"))
        await checked(pilot)
        assert "✗" not in "".join(app.lines())
        assert app.form.value is not None


async def test_ctrl_s_hands_over_what_is_right_and_goes_to_what_is_wrong() -> None:
    app = FormApp("std_msgs/msg/String")
    async with app.run_test(size=(80, 24)) as pilot:
        await checked(pilot)
        app.form.editor.focus()
        app.form.editor.replace_all("# a word\ndata: on")
        # At once: what is handed over is what stands there, not what was checked last.
        await pilot.press("ctrl+s")
        assert app.submitted == []
        assert app.form.editor.cursor_location == (1, 6)
        app.form.editor.replace_all('data: "on"')
        await pilot.press("ctrl+s")
        await pilot.pause()
        assert app.submitted == [{"data": "on"}]


async def test_no_yaml_is_marked_too() -> None:
    app = FormApp("std_msgs/msg/String")
    async with app.run_test(size=(80, 24)) as pilot:
        await checked(pilot)
        app.form.editor.replace_all("data: [1, 2")
        await checked(pilot)
        assert app.form.verdict == "✗ line 1: this list is not closed: a ',' or a ']' is missing"
        assert "✗" in app.lines()[0]


async def test_a_type_that_is_not_there_says_so() -> None:
    app = FormApp("nope_msgs/msg/Thing")
    async with app.run_test(size=(80, 24)):
        await until(lambda: app.form.error is not None, "the error")
        assert "package nope_msgs is not installed" in app.form.verdict
        assert app.form.value is None


async def test_another_type_takes_the_place_of_the_first() -> None:
    app = FormApp(DRIVE)
    async with app.run_test(size=(80, 24)) as pilot:
        await checked(pilot)
        await app.form.load("std_msgs/msg/Empty").wait()
        assert app.form.text == "{}\n"
        assert app.form.value == {}
        await app.form.load("std_msgs/msg/Bool", "data: true").wait()
        assert app.form.value == {"data": True}


async def test_a_form_whose_type_is_not_chosen_here_says_that_it_is_loading(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    app = FormApp("")
    app.form = YamlForm(type_is_given=True)
    held = threading.Event()

    def slow(type_name: str) -> str:
        held.wait(10)
        return prefilled(type_name)

    monkeypatch.setattr(yaml_form, "prefilled", slow)
    async with app.run_test(size=(80, 24)) as pilot:
        assert app.form.verdict == "the form is being loaded…"
        app.form.load("std_msgs/msg/Bool")
        assert app.form.verdict == "the form is being loaded…"
        held.set()
        await checked(pilot)
        assert app.form.verdict == "✓ valid std_msgs/msg/Bool"


async def test_hostile_text_in_the_form_is_harmless() -> None:
    app = FormApp("std_msgs/msg/String")
    async with app.run_test(size=(80, 24)) as pilot:
        await checked(pilot)
        app.form.editor.replace_all('data: "\x1b]52;c;QQ==\x07[red]\u202e\U000e0065"')
        await checked(pilot)
        assert app.lines()[0] == r'1  data: "\u001B]52;c;QQ==\u0007[red]\u202E\U000E0065"'
        assert app.form.value == {"data": "\x1b]52;c;QQ==\x07[red]\u202e\U000e0065"}
        assert "\x1b" not in app.form.verdict
