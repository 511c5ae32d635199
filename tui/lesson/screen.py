"""What the lesson asks for, how far the learner's nodes are, and help in stages."""

from __future__ import annotations

import asyncio
import contextlib
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

from textual import on, work
from textual.containers import Container, Vertical, VerticalScroll
from textual.content import Content
from textual.widgets import Static

from launcher.errors import LauncherError
from text.i18n import N_, _, language, localized
from text.plain import plain
from text.program import deck_command
from text.sentences import reason_of
from tui.actions import bindings
from tui.dialogs.choice import ChoiceScreen
from tui.editing import edit_node
from tui.frame.screen import DeckScreen
from tui.lesson import words
from tui.lesson.actions import LESSON_ACTIONS
from tui.lesson.at_work import LessonAtWork
from tui.lesson.judged import judged_lines, where_lessons_are
from tui.lesson.place import put
from tui.lesson.reading import drawn
from tui.session.messages import SessionChanged
from tui.session.requests import OpenRequest
from tui.session.words import node_command

if TYPE_CHECKING:
    from textual.app import ComposeResult
    from textual.binding import BindingType

    from course.lessons.lesson import LessonFolder
    from launcher.profile.steps.model import StepDocument
    from launcher.status import NodeStatus
    from tui.session.messages import LanguageChanged, StatusChanged


class LessonScreen(DeckScreen):
    """The step above or beside its checks; a judge looks at the nodes as long as they run."""

    tab: ClassVar[str] = "lesson"
    parts: ClassVar[tuple[str, ...]] = ("#lesson-reading", "#lesson-side")
    about: ClassVar[str] = N_(
        "What this step asks you to write, and what is judged of your running nodes: each check "
        "says what is expected, what was seen instead, and where to look. Save your file, and its "
        "node is started again and judged. A step that has passed stays green until Enter goes "
        "on. The numbers that are asked for differ each time: the seed says which they are. Tab "
        "goes from the text to the task and its checks and back; arrows scroll either."
    )
    BINDINGS: ClassVar[list[BindingType]] = bindings(*LESSON_ACTIONS)
    DEFAULT_CSS = """
    LessonScreen {
        #lesson-none { height: 1fr; padding: 1 2; color: $text-muted; }
        #lesson { height: 1fr; layout: vertical; }
        #lesson-head { height: auto; max-height: 2; padding: 0 1; background: $panel; }
        #lesson-overview { height: 1; padding: 0 1; background: $panel; }
        #lesson-body { height: 1fr; layout: vertical; }
        #lesson-reading { height: 1fr; padding: 0 1; scrollbar-size-vertical: 1; }
        #lesson-text, #lesson-checks, #lesson-file, #lesson-hints { height: auto; }
        #lesson-side {
            height: auto; max-height: 75%; border-top: solid $panel;
            scrollbar-size-vertical: 1;
        }
        #lesson-task { dock: top; height: auto; padding: 0 1; background: $boost; }
        #lesson-judged { height: auto; padding: 0 1; }
        &.-home #lesson-body, &.-wide #lesson-body { layout: horizontal; }
        &.-home #lesson-reading, &.-wide #lesson-reading { width: 11fr; height: 1fr; }
        &.-home #lesson-side, &.-wide #lesson-side {
            width: 9fr; height: 1fr; max-height: 100%; border-top: none; border-left: solid $panel;
        }
        #lesson-side.-maximized { border: none !important; }
        &.-compares.-compact #lesson-side, &.-compares.-tiny #lesson-side { display: none; }
        &.-tall #lesson-judged > *, &.-high #lesson-judged > * { margin-top: 1; }
    }
    """

    def __init__(self) -> None:
        super().__init__()
        self.beside: bool = False
        """Whether the solution is shown beside the learner's file."""
        self._shown: dict[str, tuple[object, ...]] = {}
        """What each text was drawn from."""
        self._focused_for: LessonFolder | None = None

    @property
    def at_work(self) -> LessonAtWork:
        return LessonAtWork.of(self)

    def compose_body(self) -> ComposeResult:
        """The step, its text, and what is judged; or words in their place."""
        yield Static(id="lesson-none", markup=False)
        with Vertical(id="lesson"):
            yield Static(id="lesson-head", markup=False)
            yield Static(id="lesson-overview", markup=False)
            with Container(id="lesson-body"):
                with VerticalScroll(id="lesson-reading"):
                    yield Static(id="lesson-text", markup=False)
                with VerticalScroll(id="lesson-side"):
                    yield Static(id="lesson-task", markup=False)
                    with Vertical(id="lesson-judged"):
                        yield Static(id="lesson-checks", markup=False)
                        yield Static(id="lesson-file", markup=False)
                        yield Static(id="lesson-hints", markup=False)

    def on_mount(self) -> None:
        """Begin with the lesson, or say that there is nothing yet."""
        self.at_work.show_on(self, self._show)
        self._show()

    @on(SessionChanged)
    def _session_changed(self, message: SessionChanged) -> None:
        self.at_work.session_changed(self, message)

    # Actions

    @property
    def can_compare(self) -> bool:
        """Whether the solution may be shown."""
        return self.at_work.saw_solution or self.at_work.passed_now

    def go(self, by: int) -> None:
        self.beside = False
        self.query_one("#lesson-reading").scroll_home(animate=False)
        self.at_work.go(by)

    def go_on(self) -> None:
        """Go to the next step, and after the last one to the next lesson."""
        if self.at_work.neighbour(1):
            self.go(1)
        else:
            self.open_own(self.at_work.next_lesson)

    @work(exclusive=True, group="hint")
    async def take_hint(self) -> None:
        """Show the next hint; after the last one the solution, if it is wanted."""
        if self.at_work.takes_solution and not self.at_work.passed_now:
            asked = ChoiceScreen(
                lambda: _("The solution"),
                lambda: _("There are no more hints. It will be noted that you saw the solution."),
                {"show": _("Show the solution")},
            )
            if not await self.app.push_screen_wait(asked):
                return
        if self.at_work.help():
            self.beside = True
            self._show()
        self.query_one("#lesson-side").scroll_end(animate=False)

    def compare(self) -> None:
        """Show the solution beside the learner's file, or the text again."""
        self.beside = not self.beside
        self._show()

    def edit(self) -> None:
        """Open the learner's file in an editor."""
        if self.at_work.node is not None:
            edit_node(self, self.at_work.node)

    async def ros2_command(self) -> str:
        """Return what starts the learner's node."""
        session, node = self.feed.session, self.at_work.node
        return "" if node is None or session is None else await node_command(session, node)

    def make_own(self) -> None:
        """Make the learner's folder, and open it."""
        self.open_own(self.at_work.folder)

    @work(exclusive=True, group="own")
    async def open_own(self, lesson: LessonFolder | None) -> None:
        """Open the learner's folder of a lesson, which is made if there is none."""
        from course.folder.folder import own_profile

        if lesson is None:
            return
        try:
            profile = await asyncio.to_thread(own_profile, lesson)
        except (LauncherError, OSError) as error:
            self.notify(plain(localized(reason_of(error))), severity="error", markup=False)
            return
        request = self.deck.sessions.request
        self.deck.sessions.move_to(OpenRequest(profile, hardware=request.hardware, domain=request.domain))

    # Display

    def on_status_changed(self, message: StatusChanged) -> None:
        """Show how the learner's nodes are; begin to judge once there are any."""
        del message
        self.at_work.status_changed(self)
        self._show()

    def on_language_changed(self, message: LanguageChanged) -> None:
        """Say everything in the current language."""
        del message
        self._show()

    def _show(self) -> None:
        if not self.is_mounted:
            return
        at_work = self.at_work
        step, lesson = at_work.step, at_work.folder
        self.query_one("#lesson").display = lesson is not None
        none = self.query_one("#lesson-none", Static)
        if lesson is None or step is None:
            put(none, Content(self._why_none()))
            return
        none.display = False
        if self._focused_for is not lesson:
            self._focused_for = lesson
            self.query_one("#lesson-reading").focus()
        ids = [one.id for one in lesson.steps]
        result = at_work.result(step)
        number = ids.index(step.id) + 1
        put(
            self.query_one("#lesson-head", Static),
            words.head(
                step, number, len(ids), result.state, at_work.was_right(step.id), saw_solution=at_work.saw_solution
            ),
        )
        earned = _("{points} of {all} points").format(
            points=at_work.progress.points(lesson.name, at_work.passed), all=lesson.points
        )
        put(self.query_one("#lesson-overview", Static), words.overview(at_work, step.id, earned))
        put(self.query_one("#lesson-checks", Static), Content("\n").join(judged_lines(at_work, self.deck)))
        put(
            self.query_one("#lesson-file", Static),
            Content("\n").join(words.file_lines(at_work.node, self._shell_words())),
        )
        put(self.query_one("#lesson-hints", Static), Content("\n").join(words.hint_lines(step, at_work.taken)))
        self._show_text(lesson, step)
        self.refresh_bindings()

    def _why_none(self) -> str:
        """Return why there is no lesson, and where there are lessons; empty while it is sought."""
        if self.feed.replay is not None:
            told = _("A recording is played: it has no nodes that could be judged.")
        elif self.feed.watching:
            told = _("Deck only watches these nodes: which lesson they belong to, it cannot know.")
        elif self.at_work.sought:
            told = _("This profile is not a lesson: it has no steps.")
        else:
            return ""
        return f"{told} {where_lessons_are(self.deck)}"

    def _shell_words(self) -> str:
        session = self.feed.session
        return "" if session is None else f"{deck_command()} shell {plain(session.name)}"

    def _show_text(self, lesson: LessonFolder, step: StepDocument) -> None:
        """Show the text of the step, or both files; drawn again only if it is another."""
        reading = self.at_work.reading
        if reading is None:
            return
        self._draw("task", reading.task(step.id))
        compares = self.beside and self.can_compare and bool(step.file)
        self.set_class(compares, "-compares")
        if compares and step.file:
            own, solution = _read(self.at_work.node), lesson.solution / step.file
            there = solution if solution.is_file() else lesson.starter / step.file
            with contextlib.suppress(OSError, UnicodeDecodeError):
                key: tuple[object, ...] = ("beside", own, str(there), language())
                if key != self._shown.get("text"):
                    self._shown["text"] = key
                    different = words.difference(own, there.read_text("utf-8"))
                    self.query_one("#lesson-text", Static).update(different)
            return
        self._draw("text", reading.explained(step.id))

    def _draw(self, name: str, text: str) -> None:
        """Show a text; drawn again only if it is another."""
        key = (text, self.app.current_theme.dark)
        if key != self._shown.get(name):
            self._shown[name] = key
            place = self.query_one(f"#lesson-{name}", Static)
            place.display = bool(text)
            place.update(drawn(text, dark=self.app.current_theme.dark))


def _read(node: NodeStatus | None) -> str:
    if node is None:
        return ""
    try:
        return Path(node.file).read_text("utf-8")
    except (OSError, UnicodeDecodeError):
        return ""
