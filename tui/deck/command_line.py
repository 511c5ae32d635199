"""The line in which a person types what an AI would publish on /ai_command."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.message import Message
from textual.suggester import Suggester
from textual.widgets import Input, Static

from text.i18n import _, decimal, language
from text.plain import plain
from tui.widgets.field import Field
from tui.widgets.recalled import Recalled

if TYPE_CHECKING:
    from textual.app import ComposeResult
    from textual.widget import Widget

KEPT = 100
LONGEST = 200


def words_in_order(code: str) -> list[str]:
    """The words of the current language first, then those of the other."""
    from robot.words import WORDS

    return [word for key in sorted(WORDS, key=lambda key: key != code) for word in WORDS[key]]


class WordSuggester(Suggester):
    """Completes a word of either language."""

    def __init__(self) -> None:
        """Disable caching: there are few words, and the language may change."""
        super().__init__(use_cache=False, case_sensitive=True)

    async def get_suggestion(self, value: str) -> str | None:
        """The first word that starts with the text typed so far; case is ignored, ё counts as е."""
        start = value.casefold().replace("ё", "е")
        for word in words_in_order(language()) if start else ():
            if word.startswith(start):
                return value + word[len(start) :]
        return None


class CommandLine(Vertical):
    """A text field with the words the robot knows; Enter posts `CommandSent`.

    It warns of an unknown word while it is typed, but sends it all the same: the node that listens
    will report what it makes of it.
    """

    DEFAULT_CSS = """
    CommandLine {
        height: 2;
        width: 1fr;
        Input { width: 1fr; }
        Static { width: 1fr; height: 1; color: $foreground 60%; text-wrap: nowrap; }
        Static { text-overflow: ellipsis; }
        Static.-warning { color: $text-warning; text-style: bold; }
    }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("up", "recall(-1)", show=False),
        Binding("down", "recall(1)", show=False),
    ]

    class CommandSent(Message):
        """A command to be published."""

        def __init__(self, line: CommandLine, text: str) -> None:
            """Carry the text without surrounding blanks."""
            super().__init__()
            self.line, self.text = line, text

        @property
        def control(self) -> Widget:
            return self.line

    def __init__(self, id: str | None = None, classes: str | None = None) -> None:
        """Start empty, with no listener known."""
        super().__init__(id=id, classes=classes)
        self._listeners: int | None = None
        self._said = Recalled(KEPT)

    def compose(self) -> ComposeResult:
        """The field and a remark below it."""
        yield Field(compact=True, suggester=WordSuggester(), max_length=LONGEST)
        yield Static("", markup=False)

    def on_mount(self) -> None:
        self.on_language_changed()

    @property
    def field(self) -> Input:
        return self.query_one(Input)

    def show_listeners(self, count: int) -> None:
        """Show how many nodes listen for commands."""
        if count != self._listeners:
            self._listeners = count
            self._show_remark()

    def on_language_changed(self) -> None:
        """Redraw in the current language."""
        from robot.words import WORDS

        self.field.placeholder = ", ".join(WORDS[language()])
        self._show_remark()

    def action_recall(self, step: int) -> None:
        """Bring back an earlier (-1) or later (1) command."""
        text = self._said.step(step, self.field.value)
        if text is not None:
            self.field.value = text
            self.field.cursor_position = len(text)

    def on_input_changed(self, event: Input.Changed) -> None:
        """Show what the robot will make of the text."""
        event.stop()
        self._show_remark()

    def on_input_submitted(self, event: Input.Submitted) -> None:
        """Send the command and add it to the history."""
        event.stop()
        text = event.value.strip()
        if not text:
            return
        self._said.keep(text)
        event.input.value = ""
        self.post_message(self.CommandSent(self, text))

    def _remark(self) -> tuple[str, bool]:
        """The text of the remark, and whether it is a warning."""
        text = self.field.value.strip()
        if self._listeners == 0:
            return _("nobody listens to /ai_command: start ai_driver"), True
        if not text:
            return _("Enter sends, up and down recall"), False
        from robot.words import parse_word

        setpoint = parse_word(text)
        if setpoint is not None:
            words = _("{speed} m/s, steering {steering} rad")
            speed, steering = (decimal(f"{setpoint.speed_m_s:g}"), decimal(f"{setpoint.steering_rad:g}"))
            return words.format(speed=speed, steering=steering), False
        if any(word.startswith(text.casefold()) for word in words_in_order(language())):
            return _("→ completes the word"), False
        words = _("unknown word “{text}”; Enter sends it all the same")
        return words.format(text=plain(text, 20)), True

    def _show_remark(self) -> None:
        if self.is_mounted:
            words, warning = self._remark()
            remark = self.query_one(Static)
            remark.update(words)
            remark.set_class(warning, "-warning")
