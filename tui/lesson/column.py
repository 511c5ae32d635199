"""The lesson beside the nodes that it is about: the step, its task and checks, and its text."""

from __future__ import annotations

from typing import TYPE_CHECKING

from textual.containers import VerticalScroll
from textual.content import Content
from textual.widgets import Static

from text.i18n import _
from tui.frame.host import host_of
from tui.lesson import words
from tui.lesson.judged import judged_lines
from tui.lesson.place import put
from tui.lesson.reading import drawn

if TYPE_CHECKING:
    from textual.app import ComposeResult
    from textual.screen import Screen

    from tui.lesson.at_work import LessonAtWork
    from tui.session.messages import SessionChanged


class LessonColumn(VerticalScroll):
    """What the Lesson screen shows of the step at hand, to be read; its keys are on that screen."""

    DEFAULT_CSS = """
    LessonColumn {
        width: 1fr; padding: 0 1; border-right: solid $panel; scrollbar-size-vertical: 1;
        Static { height: auto; margin-bottom: 1; }
        .task { background: $boost; }
    }
    """

    def __init__(self, at_work: LessonAtWork) -> None:
        super().__init__()
        self._at_work = at_work
        self._shown: tuple[object, ...] = ()
        """What the texts were drawn from."""

    def compose(self) -> ComposeResult:
        """What is short comes first."""
        for name in ("head", "task", "checks", "hints", "text"):
            yield Static(classes=name, markup=False)

    def on_language_changed(self) -> None:
        self.show()

    def follow(self, screen: Screen[None]) -> None:
        self._at_work.show_on(screen, self.show)
        self.show()

    def session_changed(self, screen: Screen[None], message: SessionChanged) -> None:
        self._at_work.session_changed(screen, message)
        self.show()

    def status_changed(self, screen: Screen[None]) -> None:
        """Show how the learner's nodes are."""
        self._at_work.status_changed(screen)
        self.show()

    def show(self) -> None:
        """Show how things stand; what has not changed costs nothing."""
        if not self.is_mounted:
            return
        at_work = self._at_work
        step = at_work.step
        if at_work.folder is None or step is None:
            self._put("head", Content(_("This profile is not a lesson: it has no steps.") if at_work.sought else ""))
            return
        ids = [one.id for one in at_work.folder.steps]
        number = ids.index(step.id) + 1
        self._put(
            "head",
            words.head(
                step,
                number,
                len(ids),
                at_work.result(step).state,
                at_work.was_right(step.id),
                saw_solution=at_work.saw_solution,
            ),
        )
        self._put("checks", Content("\n").join(judged_lines(at_work, host_of(self), beside=True)))
        self._put("hints", Content("\n").join(words.hint_lines(step, at_work.taken)))
        if at_work.reading is None:
            return
        task, text = at_work.reading.task(step.id), at_work.reading.explained(step.id)
        dark = self.app.current_theme.dark
        if self._shown != (task, text, dark):
            self._shown = (task, text, dark)
            for name, markdown in (("task", task), ("text", text)):
                place = self.query_one(f".{name}", Static)
                place.display = bool(markdown)
                place.update(drawn(markdown, dark=dark))
            self.scroll_home(animate=False)

    def _put(self, name: str, content: Content) -> None:
        put(self.query_one(f".{name}", Static), content)
