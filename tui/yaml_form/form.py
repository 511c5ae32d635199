"""A form for a message in YAML, checked against its type during typing."""

from __future__ import annotations

import asyncio
import re
from collections.abc import Iterable, Iterator, Mapping
from typing import ClassVar

from textual import getters, on
from textual.app import ComposeResult
from textual.containers import Vertical
from textual.events import Click
from textual.message import Message
from textual.timer import Timer
from textual.widgets import Static, TextArea
from textual.worker import Worker

from graph.data import Value
from graph.messages.making import FieldError
from graph.messages.types import UnknownTypeError
from graph.messages.yaml_form import check, prefilled
from text.i18n import N_, _
from text.plain import plain
from text.yaml_faults import YamlError
from text.yaml_scalars import escaped, meaning
from tui.actions import Acting, Announce, bindings
from tui.widgets.marked_editor import MarkedEditor, Token
from tui.widgets.working import Working
from tui.yaml_form.words import Wrong, place_of, wrong_words

CHECKED_AFTER_S = 0.15

action: Announce[YamlForm] = Announce()


@action(
    "form.submit",
    "ctrl+s",
    N_("Submit"),
    N_("Take the message as it is filled in, if nothing is wrong with it."),
    means="submit",
    footer=True,
    priority=True,
    when=lambda form: form.submits,
    label=lambda form: form.submit_title or N_("Submit"),
)
def submit_form(form: YamlForm) -> None:
    form.submit()


_TOKEN = re.compile(
    r"""
    (?P<comment>(?:^|(?<=\s))\#.*)
    | (?P<string>"(?:[^"\\]|\\.)*"? | '(?:[^']|'')*'?)
    | (?P<mark>[\[\]{},] | [-:](?=\s|$))
    | (?P<plain>(?:[^\s\[\]{},:] | :(?!\s|$))+)
    """,
    re.VERBOSE,
)
_KEY_FOLLOWS = re.compile(r"\s*:(?=\s|$)")


def tokens(line: str) -> Iterator[Token]:
    """Yield the tokens of a line in order; accepts any text."""
    for match in _TOKEN.finditer(line):
        yield Token(match.start(), match.end(), _kind(match, line))


def _kind(match: re.Match[str], line: str) -> str:
    kind = match.lastgroup or "plain"
    if kind in {"comment", "mark"}:
        return kind
    if _KEY_FOLLOWS.match(line, match.end()):
        return "key"
    if kind == "string":
        return kind
    value = meaning(match.group())
    if isinstance(value, str):
        return "string"
    return "word" if value is None or isinstance(value, bool) else "number"


class YamlEditor(MarkedEditor):
    """Edits YAML; Enter starts a new line with the indentation of the current one."""

    def escaped(self, character: str) -> str:
        return escaped(character)

    def tokens_of(self, line: str) -> Iterable[Token]:
        return tokens(line)


class YamlForm(Vertical, Acting, Working):
    """An editor with a verdict below it that says the line, the field and what was expected."""

    class Submitted(Message):
        """The form is valid, and Ctrl+S was pressed."""

        def __init__(self, value: Mapping[str, Value]) -> None:
            super().__init__()
            self.value = value

    class Checked(Message):
        """The text was checked: the form's `error` says what is wrong, None if nothing is."""

    BINDINGS: ClassVar = bindings(submit_form)
    DEFAULT_CSS = """
    YamlForm {
        height: 1fr;
        & > Static {
            height: auto; max-height: 3; background: $panel; color: $success; padding: 0 1;
        }
        &.-wrong > Static { color: $text-error; text-style: bold; }
        &.-waits > Static { color: $text-muted; }
    }
    """

    def __init__(
        self,
        type_name: str = "",
        *,
        submit_title: str = "",
        submits: bool = True,
        type_is_given: bool = False,
        id: str = "",
    ) -> None:
        """Start with a type's form; `submit_title` (an `N_`) is what the footer calls Ctrl+S.

        `submits=False` leaves Ctrl+S to the screen around it. `type_is_given`: the user cannot
        choose the type, it is set by the program.
        """
        super().__init__(id=id or None)
        self.type_name = type_name
        self.submit_title: str = submit_title
        self.submits: bool = submits
        self.type_is_given = type_is_given
        self.error: Wrong | None = None
        """What is wrong with the text that was checked last."""
        self._value: Mapping[str, Value] | None = None
        self._checked: str | None = None
        self._timer: Timer | None = None
        self._loading = False

    def compose(self) -> ComposeResult:
        yield YamlEditor()
        yield Static(markup=False)

    def on_mount(self) -> None:
        if self.type_name:
            self.load(self.type_name)
        else:
            self.on_language_changed()

    editor = getters.query_one(YamlEditor)

    @property
    def text(self) -> str:
        return self.editor.text

    @property
    def value(self) -> Mapping[str, Value] | None:
        """The field values, None while something is wrong."""
        self.check_now()
        return None if self._loading else self._value

    @property
    def verdict(self) -> str:
        return str(self.query_one(Static).content)

    def load(self, type_name: str, text: str | None = None) -> Worker[None]:
        """Show the form of another type, or `text` in it; the worker ends when it is shown."""
        self.type_name = type_name
        self._loading = True
        self._checked = self._value = self.error = None
        self.editor.show_problems(())
        self.on_language_changed()
        return self.run_worker(self._load(type_name, text), group="load", exclusive=True)

    def submit(self) -> None:
        """Check the text and report that it was submitted, or go to what is wrong."""
        value = self.value
        if value is None:
            self.go_to_problem()
            self.app.bell()
        else:
            self.post_message(self.Submitted(value))

    def go_to_problem(self) -> None:
        place = None if self.error is None else place_of(self.error)
        if place is not None:
            self.editor.go_to(place)

    def check_now(self) -> None:
        """Check the text at once, blocking the screen."""
        if self.type_name and not self._loading and self.text != self._checked:
            self._take(self.text, _checked(self.type_name, self.text))

    def on_language_changed(self) -> None:
        words = "✓ " + _("valid {type}").format(type=plain(self.type_name, 100))
        if self._loading or (self.type_is_given and not self.type_name):
            words = _("the form is being loaded…")
        elif not self.type_name:
            words = _("choose a type first")
        elif self._checked is None:
            words = "…"
        elif self.error is not None:
            words = f"✗ {wrong_words(self.error)}"
        self.set_class(self.error is not None, "-wrong")
        self.set_class(self._checked is None, "-waits")
        self.query_one(Static).update(words)

    async def _load(self, type_name: str, text: str | None) -> None:
        # The first use of a package imports it, which takes time.
        try:
            form = await asyncio.to_thread(prefilled, type_name)
        except UnknownTypeError as error:
            self._loading = False
            self.editor.replace_all(text or "")
            self._take(self.text, error)
            return
        self._loading = False
        self.editor.replace_all(form if text is None else text)
        await self._check()

    def on_click(self, event: Click) -> None:
        if isinstance(event.widget, Static):
            self.go_to_problem()

    @on(TextArea.Changed)
    def _text_changed(self, event: TextArea.Changed) -> None:
        event.stop()
        if self._timer is not None:
            self._timer.stop()
        self._timer = self.set_timer(CHECKED_AFTER_S, self._check_soon)

    @on(YamlEditor.TooLong)
    def _too_long(self, event: YamlEditor.TooLong) -> None:
        event.stop()
        words = _("Not pasted: {limit} bytes at most.").format(limit=YamlEditor.longest)
        self.notify(words, severity="warning", markup=False)

    def _check_soon(self) -> None:
        if self.type_name and not self._loading and self.text != self._checked:
            self.run_worker(self._check(), group="check", exclusive=True)

    async def _check(self) -> None:
        type_name, text = self.type_name, self.text
        found = await asyncio.to_thread(_checked, type_name, text)
        if (type_name, text) == (self.type_name, self.text):
            self._take(text, found)

    def _take(self, text: str, found: Mapping[str, Value] | Wrong) -> None:
        self._checked = text
        if isinstance(found, (YamlError, FieldError, UnknownTypeError)):
            self.error, self._value = found, None
        else:
            self.error, self._value = None, found
        place = None if self.error is None else place_of(self.error)
        self.editor.show_problems(() if place is None else (place,))
        self.on_language_changed()
        self.post_message(self.Checked())


def _checked(type_name: str, text: str) -> Mapping[str, Value] | Wrong:
    try:
        return check(type_name, text)
    except (YamlError, FieldError, UnknownTypeError) as error:
        return error
