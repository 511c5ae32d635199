"""The recordings on this machine: how long, how large, whether damaged; one can be opened."""

from __future__ import annotations

import asyncio
import time
from typing import TYPE_CHECKING, ClassVar

from textual import on, work
from textual.containers import Vertical
from textual.content import Content
from textual.widgets import Static

from text.i18n import N_, _, localized
from text.os_words import os_reason
from text.plain import plain
from tui.actions import Announce, bindings
from tui.dialogs.dialog import Dialog
from tui.frame.key_bar import KeyBar
from tui.recording.words import length_words, size_words
from tui.session.requests import ReplayRequest
from tui.widgets.figures import UNKNOWN
from tui.widgets.rows import Cell, Column, Row, Rows

if TYPE_CHECKING:
    from pathlib import Path

    from textual.app import ComposeResult
    from textual.binding import BindingType

    from graph.bag.listing import ListedBag

action: Announce[RecordingsScreen] = Announce()

LONGEST = 400


@action(
    "recordings.open",
    "enter",
    N_("Open"),
    N_("Play the selected recording on the screens; what runs here ends first."),
    footer=True,
    priority=True,
    palette=False,
    when=lambda dialog: True if dialog.chosen is not None else None,
)
def open_recording(dialog: RecordingsScreen) -> None:
    dialog.open_chosen()


@action(
    "recordings.leave", "escape", N_("Close"), N_("Back, without opening a recording."), footer=True, palette=False
)
def leave_recordings(dialog: RecordingsScreen) -> None:
    dialog.dismiss(None)


class RecordingsScreen(Dialog[None]):
    """The recordings of the usual folder, the newest first; below, what is said of one of them."""

    BINDINGS: ClassVar[list[BindingType]] = bindings(open_recording, leave_recordings)
    DEFAULT_CSS = """
    RecordingsScreen {
        #dialog { width: 110; height: 90%; }
        #recordings { height: 1fr; }
        #dialog-text { height: auto; max-height: 6; padding: 0 1; margin: 1 0; }
    }
    """

    def __init__(self) -> None:
        super().__init__()
        self._folder: Path | None = None
        self._bags: list[ListedBag] | None = None
        """None while they are looked for."""
        self._refusal = ""
        """Why the folder cannot be read."""

    def compose(self) -> ComposeResult:
        """The list above what is said of the chosen one."""
        with Vertical(id="dialog"):
            yield Rows(id="recordings")
            yield Static(id="dialog-text", markup=False)
            yield KeyBar()

    def on_mount(self) -> None:
        self.query_one(Rows).focus()
        self.redraw()
        self.look()

    @work(exclusive=True)
    async def look(self) -> None:
        """Read the folder; a slow disk does not hold up the screen."""
        from launcher.rundir import recordings_path

        self._folder = recordings_path()
        self._bags, self._refusal = await asyncio.to_thread(_listed, self._folder)
        self.redraw()
        self.refresh_bindings()

    @property
    def chosen(self) -> ListedBag | None:
        chosen = next((rows.chosen for rows in self.query(Rows)), "")
        return next((bag for bag in self._bags or () if str(bag.path) == chosen), None)

    @work(exclusive=True, group="open")
    async def open_chosen(self) -> None:
        """End what is shown, and play the chosen recording; nothing ends for one without use."""
        bag, sessions = self.chosen, self.deck.sessions
        if bag is None:
            return
        refusal = await asyncio.to_thread(_refusal, bag.path)
        if not self.is_current:
            return
        if refusal:
            self.notify(plain(localized(refusal), LONGEST), severity="error", markup=False)
            return
        request = sessions.request._replace(profile=None, attach=None, watch=None, replay=ReplayRequest(bag.path))
        opened = self.deck.feed.opened
        self.dismiss(None)
        (sessions.move_to if opened else sessions.open)(request)

    @on(Rows.Opened)
    def _opened(self, message: Rows.Opened) -> None:
        message.stop()
        self.open_chosen()

    @on(Rows.Highlighted)
    def _chosen_changed(self, message: Rows.Highlighted) -> None:
        message.stop()
        self.redraw()

    def title_words(self) -> str:
        return _("Recordings")

    def redraw(self) -> None:
        """Show list and words in the current language."""
        narrow = self.app.size.width < 100
        columns = [
            Column("", 1),
            Column(_("Name")),
            Column(_("Ended"), 16),
            Column(_("Length"), 7, right=True),
            *([] if narrow else [Column(_("Topics"), 7, right=True)]),
            Column(_("Messages"), 9, right=True),
            Column(_("Size"), 7, right=True),
        ]
        rows = [_row(bag, topics=not narrow) for bag in self._bags or ()]
        self.query_one(Rows).show(columns, rows)
        super().redraw()

    def words(self) -> Content:
        """Return where the chosen one is and what is wrong with it, or why there is none."""
        bag = self.chosen
        if bag is None:
            return Content(self._why_none())
        lines = [Content.styled(plain(str(bag.path), LONGEST), "$text-muted")]
        if bag.trouble:
            why = plain(localized(bag.trouble), LONGEST)
            lines.append(Content.styled(f"✗ {why}", "$text-warning"))
        link = self.deck.feed.link
        if link is not None and link.own:
            lines.append(Content(_("Opening it ends the lesson that runs here.")))
        return Content("\n").join(lines)

    def _why_none(self) -> str:
        if self._bags is None:
            return _("Looking for recordings…")
        folder = plain(str(self._folder), LONGEST)
        if self._refusal:
            words = _("{folder} cannot be read: {reason}")
            return words.format(folder=folder, reason=localized(self._refusal))
        words = _("no recordings in {folder}: F6 on the screen or `deck record` makes one")
        return words.format(folder=folder)


def _listed(folder: Path) -> tuple[list[ListedBag], str]:
    """Return the recordings of a folder, or why it cannot be read."""
    from graph.bag.listing import bags_in

    try:
        next(folder.iterdir(), None)
    except FileNotFoundError:
        return [], ""
    except OSError as error:
        return [], os_reason(error)
    return bags_in(folder), ""


def _refusal(path: Path) -> str:
    """Return why a recording cannot be played, empty if it can."""
    from graph.bag.errors import BagError
    from graph.bag.reading import open_bag

    try:
        open_bag(path).close()
    except BagError as error:
        return error.words
    return ""


def _row(bag: ListedBag, *, topics: bool) -> Row:
    ended = time.strftime("%Y-%m-%d %H:%M", time.localtime(bag.changed_s))
    look = "warn" if bag.trouble else ""
    texts = [
        "✗" if bag.trouble else " ",
        plain(bag.name, LONGEST),
        ended,
        UNKNOWN if bag.seconds is None else length_words(bag.seconds),
        *([UNKNOWN if bag.topics is None else str(bag.topics)] if topics else []),
        UNKNOWN if bag.messages is None else str(bag.messages),
        size_words(bag.bytes),
    ]
    return Row(str(bag.path), tuple(Cell(text, look) for text in texts))
