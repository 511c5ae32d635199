"""Whether the JSON is valid and, if not, a list of problems that leads to their places."""

from __future__ import annotations

from typing import TYPE_CHECKING

from textual import on
from textual.containers import Vertical
from textual.message import Message
from textual.widgets import OptionList, Static

from text.i18n import _, ngettext
from tui.outcome.problem_words import problem_words
from tui.widgets.marked_editor import TextPlace

if TYPE_CHECKING:
    from textual.app import ComposeResult

    from robot.commands.schema import Problem


class JsonVerdict(Vertical):
    """One line with a mark and a word, and below it the problems; Enter goes to where one is."""

    class ProblemWanted(Message):
        """The user wants to go to the place of a problem."""

        def __init__(self, place: TextPlace) -> None:
            super().__init__()
            self.place = place

    DEFAULT_CSS = """
    JsonVerdict {
        height: auto; max-height: 40%;
        & > Static { height: 1; background: $panel; color: $text-success; padding: 0 1; }
        & > OptionList {
            height: auto; max-height: 1fr; display: none; background: $background; padding: 0 1;
            scrollbar-size: 1 1;
        }
        &.-wrong > Static { color: $text-error; text-style: bold; }
        &.-wrong > OptionList { display: block; }
        &.-coming > Static { color: $text-accent; text-style: none; }
    }
    """

    def __init__(self) -> None:
        super().__init__()
        self._problems: tuple[Problem, ...] = ()
        self._commands: int | None = None
        self._coming = ""

    def compose(self) -> ComposeResult:
        """The verdict above the list of problems."""
        yield Static(markup=False)
        yield OptionList(markup=False, compact=True)

    def show(self, problems: tuple[Problem, ...], commands: int) -> None:
        """Show the problems or, if there are none, the number of commands."""
        self._show(problems, commands, "")

    def show_under_way(self, words: str, problems: tuple[Problem, ...]) -> None:
        """Show how far an answer has come, and what is wrong with it already."""
        self._show(problems, 0, words)

    def _show(self, problems: tuple[Problem, ...], commands: int, coming: str) -> None:
        if (problems, commands, coming) != (self._problems, self._commands, self._coming):
            self._problems, self._commands, self._coming = problems, commands, coming
            self._say()

    def relabel(self) -> None:
        """Redraw in the current language."""
        if self._commands is not None:
            self._say()

    @property
    def problems(self) -> tuple[Problem, ...]:
        """The current problems; none of an answer that still comes."""
        return () if self._coming else self._problems

    def _say(self) -> None:
        self.set_class(bool(self._problems), "-wrong")
        self.set_class(bool(self._coming) and not self._problems, "-coming")
        count = len(self._problems)
        if self._coming:
            words = f"{'✗' if count else '…'} {self._coming}"
        elif count:
            words = "✗ " + ngettext("{n} problem", "{n} problems", count).format(n=count)
        else:
            commands = self._commands or 0
            words = "✓ " + _("valid: {commands}").format(
                commands=ngettext("{n} command", "{n} commands", commands).format(n=commands)
            )
        self.query_one(Static).update(words)
        listed = self.query_one(OptionList)
        listed.clear_options()
        listed.add_options([problem_words(problem) for problem in self._problems])

    @on(OptionList.OptionSelected)
    def _selected(self, event: OptionList.OptionSelected) -> None:
        event.stop()
        problem = self._problems[event.option_index]
        self.post_message(self.ProblemWanted(TextPlace(problem.line, problem.column)))
