"""The available lessons: what each starts and shows, and what is already running."""

from __future__ import annotations

import asyncio
from contextlib import suppress
from typing import TYPE_CHECKING, ClassVar

from textual import work
from textual.containers import Horizontal, VerticalScroll
from textual.content import Content
from textual.screen import Screen
from textual.widgets import Static

from launcher.errors import LauncherError
from launcher.profile.defaults import shown
from launcher.profile.panels import PANELS
from text.i18n import N_, _, localized, ngettext, pick
from text.plain import plain
from text.sentences import reason_of
from tui.actions import Acting, Announce, bindings
from tui.frame.host import Host, host_of
from tui.frame.key_bar import KeyBar
from tui.frame.screen import BREAKPOINTS, HEIGHTS
from tui.frame.title_bar import TitleBar
from tui.session.requests import WatchRequest
from tui.session.words import hardware_words, started_words
from tui.widgets.rows import Cell, Column, Row, Rows
from tui.widgets.working import Working

if TYPE_CHECKING:
    from textual.app import ComposeResult
    from textual.binding import BindingType

    from launcher.status import SessionInfo
    from tui.session.messages import LanguageChanged
    from tui.session.requests import Lesson, OpenRequest, Score, Task

STEPS, POINTS = 6, 8
"""Widths of the columns."""

action: Announce[PickerScreen] = Announce()

RUNNING_WITHIN_S = 0.5
"""From then on the list is shown without what runs; it moves nothing that comes later."""
OWN = "✎"
"""Marks a lesson for which the learner has files."""
RUNNING = "running:"
WATCHED = "watch:"
"""Prefix of the row for nodes that others have started."""


@action(
    "lesson.start",
    "enter",
    N_("Start"),
    N_("Start the selected lesson: your own files if there are any, else Deck's nodes."),
    footer=True,
    priority=True,
    when=lambda dialog: True if dialog.request() is not None else None,
    label=lambda dialog: (
        N_("My own files") if dialog.chosen_task is not None and dialog.chosen_task.own else N_("Start")
    ),
)
def start_lesson(dialog: PickerScreen) -> None:
    dialog.open_chosen()


def _has_no_folder(dialog: PickerScreen) -> bool | None:
    """Only for a lesson with something to do; Enter starts a folder that is there."""
    task = dialog.chosen_task
    return task is not None and task.own is None


@action(
    "lesson.start_own",
    "C",
    N_("My own files"),
    N_("Make a folder of your own for the selected lesson, and start your files."),
    means="own files",
    footer=True,
    when=_has_no_folder,
)
def start_own(dialog: PickerScreen) -> None:
    dialog.start_own()


@action(
    "lesson.start_decks",
    "u",
    N_("Deck's nodes"),
    N_("Start the selected lesson with Deck's own nodes in the place of your files."),
    means="own or Deck's",
    footer=True,
    when=lambda dialog: dialog.chosen_task is not None and dialog.chosen_task.own is not None,
)
def start_decks(dialog: PickerScreen) -> None:
    dialog.open_chosen(own=False)


class PickerScreen(Screen[None], Acting, Working):
    """A list of lessons, and beside or below it the details of the chosen one."""

    BINDINGS: ClassVar[list[BindingType]] = bindings(start_lesson, start_own, start_decks)
    HORIZONTAL_BREAKPOINTS = BREAKPOINTS
    VERTICAL_BREAKPOINTS = HEIGHTS
    DEFAULT_CSS = """
    PickerScreen {
        #picker { height: 1fr; layout: vertical; }
        #lessons { height: auto; max-height: 16; }
        #about { height: 1fr; min-height: 5; padding: 0 2; border-top: solid $panel; }
        #about-text { height: auto; }
        &.-home #picker, &.-wide #picker { layout: horizontal; }
        &.-home #lessons, &.-wide #lessons {
            width: 5fr; height: 1fr; max-height: 100%; margin: 1 1;
        }
        &.-home #about, &.-wide #about {
            width: 4fr; height: 1fr; padding: 2 3; border-top: none; border-left: solid $panel;
        }
        &.-flat #about { display: none; }
        &.-flat #lessons { height: 1fr; max-height: 100%; margin: 0; }
    }
    """

    def __init__(self) -> None:
        super().__init__()
        self._lessons: list[Lesson] = []
        self._sessions: list[SessionInfo] = []
        self._offered = self._left_off = ""
        self._domain: int | None = None
        """The domain to watch without a lesson; None if the configured one is invalid."""

    @property
    def deck(self) -> Host:
        return host_of(self)

    def compose(self) -> ComposeResult:
        """Put the list beside the details of the chosen lesson."""
        yield TitleBar()
        with Horizontal(id="picker"):
            yield Rows(header=False, id="lessons")
            with VerticalScroll(id="about", can_focus=False):
                yield Static(id="about-text", markup=False)
        yield KeyBar()

    def on_mount(self) -> None:
        """Show the list once it is known."""
        self.query_one(Rows).focus()
        self.redraw()
        self.look()

    def on_screen_resume(self) -> None:
        """Refresh the list: sessions come and go."""
        if self._lessons:
            self.look()

    @work(exclusive=True)
    async def look(self) -> None:
        """Read the lessons and the running sessions."""
        with suppress(LauncherError):
            self._domain = self.deck.sessions.opener.domain(self.deck.sessions.request.domain)
        running = asyncio.ensure_future(self.deck.sessions.opener.running())
        self._lessons = self._with_known_scores(await self.deck.sessions.opener.lessons())
        await asyncio.wait({running}, timeout=RUNNING_WITHIN_S)
        if not running.done():
            self._offer()
        self._sessions = await running
        self._offer()
        self._lessons = await self.deck.sessions.opener.scored(self._lessons)
        self.redraw()
        if self.is_current:
            await self.deck.sessions.opener.prepare()

    def _with_known_scores(self, lessons: list[Lesson]) -> list[Lesson]:
        """Return lessons with the scores from before, which are shown until they are read again."""
        known = {one.task.folder: one.task.score for one in self._lessons if one.task is not None}
        return [
            lesson
            if lesson.task is None or lesson.task.score is not None
            else lesson._replace(task=lesson.task._replace(score=known.get(lesson.task.folder)))
            for lesson in lessons
        ]

    def _offer(self) -> None:
        """Show the list, with the likeliest row chosen: at first, and after a session of another.

        Whatever comes later moves the cursor no more.
        """
        self.redraw()
        last = self.deck.sessions.last_lesson
        if not self._offered or last != self._left_off:
            self._offered, self._left_off = self._first(), last
            self.query_one(Rows).choose(self._offered)

    def _first(self) -> str:
        """Return the initial row: where one has left off, a running session, the first lesson."""
        last = self.deck.sessions.last_lesson
        named = [_key(lesson) for lesson in self._lessons if lesson.name == last]
        left = [_key(one) for one in self._lessons if one.task is not None and one.task.left_off]
        running = [f"{RUNNING}{session.name}" for session in self._sessions]
        return next(iter(named or left or running or map(_key, self._lessons)), "")

    def redraw(self) -> None:
        """Redraw everything in the current language."""
        title = _("The lessons")
        self.query_one(TitleBar).show((), (title,))
        rows: list[Row] = []
        if self._sessions:
            rows.append(_heading(_("Already running")))
            rows += [self._running_row(session) for session in self._sessions]
            rows.append(_heading(""))
        if self._domain is not None:
            words = _("Look at what runs in domain {domain}").format(domain=self._domain)
            rows += [Row(WATCHED, (Cell("⌕"), Cell(words))), _heading("")]
        rows += [self._lessons_heading(), *map(self._lesson_row, self._lessons)]
        columns = [Column("", 4, right=True), Column("")]
        if any(lesson.task for lesson in self._lessons):
            columns += [Column("", STEPS, right=True), Column("", POINTS, right=True)]
        self.query_one(Rows).show(columns, rows)
        self._show_about()
        self.refresh_bindings()

    @property
    def chosen_task(self) -> Task | None:
        """What there is to do in the chosen lesson."""
        lesson = self._chosen_lesson()
        return None if lesson is None else lesson.task

    def request(self, *, own: bool = True) -> OpenRequest | None:
        """Return what Enter would open, None for nothing; not `own`: with Deck's nodes."""
        session, lesson = self._chosen_session(), self._chosen_lesson()
        if self._chosen == WATCHED and self._domain is not None:
            return self.deck.sessions.request._replace(watch=WatchRequest(self._domain))
        if session is not None:
            return self.deck.sessions.request._replace(attach=session.name)
        if lesson is not None and not lesson.error:
            mine = lesson.task.own if own and lesson.task is not None else None
            return self.deck.sessions.request._replace(profile=mine or lesson.path)
        return None

    @work(exclusive=True, group="own")
    async def start_own(self) -> None:
        """Make the learner's folder of the chosen lesson, and start it."""
        # Not needed for the first frame.
        from course.folder.folder import own_profile
        from course.lessons.lesson import LessonFolder

        if self.chosen_task is None:
            return
        try:
            profile = await asyncio.to_thread(own_profile, LessonFolder(self.chosen_task.folder))
        except (LauncherError, OSError) as error:
            self.notify(plain(localized(reason_of(error))), severity="error", markup=False)
            return
        self.deck.sessions.open(self.deck.sessions.request._replace(profile=profile))

    def open_chosen(self, *, own: bool = True) -> None:
        """Open the chosen entry; not `own`: with Deck's nodes."""
        request = self.request(own=own)
        if request is not None:
            self.deck.sessions.open(request)

    def on_language_changed(self, message: LanguageChanged) -> None:
        del message
        self.redraw()

    def on_rows_highlighted(self, message: Rows.Highlighted) -> None:
        """Show the details of the chosen entry."""
        del message
        self._show_about()
        self.refresh_bindings()

    def on_rows_opened(self, message: Rows.Opened) -> None:
        """Open an entry that was clicked twice."""
        message.stop()
        self.open_chosen()

    @property
    def _chosen(self) -> str:
        return next((rows.chosen for rows in self.query(Rows)), "")

    def _chosen_lesson(self) -> Lesson | None:
        chosen = self._chosen
        return next((lesson for lesson in self._lessons if _key(lesson) == chosen), None)

    def _chosen_session(self) -> SessionInfo | None:
        chosen = self._chosen
        found = (one for one in self._sessions if f"{RUNNING}{one.name}" == chosen)
        return next(found, None)

    def _running_row(self, session: SessionInfo) -> Row:
        title = _title(session.name, session.title)
        words = _("{title} · domain {domain}").format(title=title, domain=session.domain)
        cells = (Cell("▶", "good"), Cell(words))
        return Row(f"{RUNNING}{session.name}", cells)

    def _lesson_row(self, lesson: Lesson) -> Row:
        if lesson.error:
            return Row(_key(lesson), (Cell("✗", "bad"), Cell(plain(lesson.name), "bad")))
        task = lesson.task
        title = _title(lesson.name, lesson.title)
        mine = f"{title} {OWN}" if task is not None and task.own else title
        cells = (Cell(plain(lesson.lesson)), Cell(mine))
        return Row(_key(lesson), cells if task is None else (*cells, *_progress_cells(task)))

    def _lessons_heading(self) -> Row:
        words = _("Lessons") if self._lessons else _("Looking for lessons…")
        if not any(lesson.task for lesson in self._lessons):
            return _heading(words)
        points = _("points")
        cells = ("", words, _("steps"), f"{points} ")
        return Row("", tuple(Cell(text, "dim") for text in cells))

    def _show_about(self) -> None:
        session, lesson = self._chosen_session(), self._chosen_lesson()
        if session is not None:
            words = _about_session(session)
        elif lesson is not None:
            words = _about_lesson(lesson)
        elif self._chosen == WATCHED:
            words = _about_watching(self._domain)
        else:
            words = Content("")
        self.query_one("#about-text", Static).update(words)


def _key(lesson: Lesson) -> str:
    """Return the row's key: several lessons may have the same name."""
    return str(lesson.path)


def _heading(text: str) -> Row:
    return Row("", (Cell(""), Cell(text, "dim")))


def _title(name: str, title: object) -> str:
    text = pick(title) if isinstance(title, dict) else ""
    return plain(text or name, 200)


def _progress_cells(task: Task) -> tuple[Cell, Cell]:
    """Return the steps that have passed, and the points; nothing while they are being read."""
    score = task.score
    if score is None:
        return Cell(""), Cell("")
    meaning = "good" if score.passed == score.steps else "" if score.passed else "dim"
    sign = "✓ " if score.passed == score.steps else ""
    steps, points = f"{sign}{score.passed}/{score.steps}", f"{score.earned}/{score.points} "
    return Cell(steps, meaning), Cell(points, meaning)


def _about_task(task: Task) -> list[Content]:
    """Return how far the learner is, and whose nodes Enter starts."""
    lines = [Content("") if task.score is None else _about_score(task.score)]
    if task.own is not None:
        lines.append(_field(_("Your files"), plain(str(task.own.parent))))
    return lines


def _about_score(score: Score) -> Content:
    steps = ngettext("{done} of {n} step", "{done} of {n} steps", score.steps)
    points = _("{points} of {all} points").format(points=score.earned, all=score.points)
    line = f"{steps.format(done=score.passed, n=score.steps)} · {points}"
    done = score.passed == score.steps
    return Content.styled(f"✓ {line}" if done else line, "$text-success" if done else "")


def _about_session(session: SessionInfo) -> Content:
    return Content("\n").join(
        [
            Content.styled(_title(session.name, session.title), "bold $accent"),
            Content(""),
            Content(_("Already running: Enter shows it and leaves it running.")),
            Content(started_words(session)),
            Content(""),
            _field(_("Domain"), str(session.domain)),
            _field(_("Hardware"), hardware_words(session.hardware)),
            _field(_("File"), plain(session.profile)),
        ]
    )


def _about_watching(domain: int | None) -> Content:
    return Content("\n").join(
        [
            Content.styled(_("A robot that is already running"), "bold $accent"),
            Content(""),
            Content(
                _(
                    "Starts nothing. Shows nodes, topics, services and logs of whatever was started"
                    " in the domain: by `ros2 run`, by `ros2 launch`, in another window."
                )
            ),
            Content(""),
            _field(_("Domain"), str(domain)),
            _field(_("Also"), "deck watch --domain N --discovery subnet"),
        ]
    )


def _about_lesson(lesson: Lesson) -> Content:
    lines = [Content.styled(_title(lesson.name, lesson.title), "bold $accent")]
    if lesson.task is not None and not lesson.error:
        lines += _about_task(lesson.task)
    lines.append(Content(""))
    if lesson.error:
        lines.append(Content.styled(_("✗ cannot be started"), "bold $text-error"))
        lines += [Content(plain(line)) for line in localized(lesson.error).splitlines()]
        return Content("\n").join(lines)
    about = pick(lesson.about)
    if about:
        lines += [Content(plain(about, 2000)), Content("")]
    count = len(lesson.nodes)
    starts = ngettext("Starts {n} node", "Starts {n} nodes", count).format(n=count)
    lines.append(_field(starts, plain(", ".join(lesson.nodes))))
    known = ((panel, PANELS.get(panel)) for panel in lesson.panels)
    shows = [_(entry.title) if entry else plain(panel) for panel, entry in known]
    lines.append(_field(_("Shows"), ", ".join([*shows, _("log")])))
    lines.append(_field(_("File"), plain(shown(lesson.path))))
    return Content("\n").join(lines)


def _field(name: str, value: str) -> Content:
    return Content.assemble((f"{name}: ", "bold"), value)
