"""Asks before a recording begins: where it goes, how fast it grows, what to leave out."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, NamedTuple

from textual import on
from textual.containers import Horizontal, Vertical
from textual.content import Content
from textual.widgets import Input, Static

from graph.heavy_types import COMPRESSED_IMAGE, HEAVY_TYPES, IMAGE, POINT_CLOUD
from graph.housekeeping import is_hidden
from text.i18n import N_, _, ngettext
from text.plain import plain
from tui.actions import Announce, bindings
from tui.dialogs.dialog import Dialog
from tui.frame.key_bar import KeyBar
from tui.recording.recording import RecordingWish, read_limit
from tui.recording.words import length_words, size_words
from tui.widgets.field import Field
from tui.widgets.figures import UNKNOWN
from tui.widgets.rows import Cell, Column, Row, Rows

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Sequence
    from pathlib import Path

    from textual.app import ComposeResult
    from textual.binding import BindingType

    from graph.data import TopicRow

action: Announce[BeginRecordingScreen] = Announce()

LOOK_S = 0.5
"""How often the rates are looked at."""
MINUTE_S = 60.0
DAY_S = 86_400.0
DAYS_FROM = 2
LONGEST = 400
OTHERS = ""
"""Stands for all types that are not heavy."""
MESSAGE_BYTES = 47
"""What MCAP adds to each message: 31 bytes of its record, 16 in the index of its chunk."""
NAMES = {
    IMAGE: N_("Pictures (Image)"),
    COMPRESSED_IMAGE: N_("Pictures (CompressedImage)"),
    POINT_CLOUD: N_("Point clouds (PointCloud2)"),
    OTHERS: N_("All other topics"),
}


class RecordingShare(NamedTuple):
    """What the topics of one type add to a recording."""

    type_name: str
    """One of `HEAVY_TYPES`, or `OTHERS`."""
    topics: tuple[str, ...]
    bytes_per_s: float | None
    """On the disk; None while none of the topics has been measured."""


def shares(rows: Iterable[TopicRow]) -> tuple[RecordingShare, ...]:
    """Return the share of each heavy type and, as the last one, that of all others together."""
    found: dict[str, list[TopicRow]] = {kind: [] for kind in (*HEAVY_TYPES, OTHERS)}
    for row in rows:
        if row.publishers and not is_hidden(row.name):
            kind = next((kind for kind in HEAVY_TYPES if kind in row.type_names), OTHERS)
            found[kind].append(row)
    return tuple(
        RecordingShare(kind, tuple(row.name for row in of_kind), _rate(of_kind)) for kind, of_kind in found.items()
    )


def total_rate(found: Iterable[RecordingShare], left_out: Collection[str]) -> float | None:
    """Return the bytes a second of a recording without these types; None while unknown."""
    rates = [share.bytes_per_s for share in found if share.type_name not in left_out]
    return None if None in rates else sum(rate for rate in rates if rate is not None)


def _rate(rows: Sequence[TopicRow]) -> float | None:
    # A topic that is quiet has no rate, and adds nothing.
    known = [
        (row.bytes_per_s or 0.0) + MESSAGE_BYTES * (row.hz or 0.0)
        for row in rows
        if row.measured or row.bytes_per_s is not None
    ]
    return sum(known) if known or not rows else None


@action(
    "begin_recording.start",
    "enter",
    N_("Record"),
    N_("Start recording what is ticked."),
    footer=True,
    priority=True,
    palette=False,
)
def begin_recording(dialog: BeginRecordingScreen) -> None:
    dialog.begin()


@action(
    "begin_recording.leave_out",
    "m",
    N_("Leave out"),
    N_("Leave out the topics of the selected type, or record them again."),
    means="leave out",
    footer=True,
    palette=False,
    label=lambda dialog: N_("Record it too") if dialog.chosen in dialog.left_out else N_("Leave out"),
)
def leave_out(dialog: BeginRecordingScreen) -> None:
    dialog.toggle()


@action(
    "begin_recording.leave",
    "escape",
    N_("Do not record"),
    N_("Back, without recording anything."),
    footer=True,
    palette=False,
)
def no_recording(dialog: BeginRecordingScreen) -> None:
    dialog.dismiss(None)


class BeginRecordingScreen(Dialog["RecordingWish | None"]):
    """Folder and room above the shares of the topics, and when to end; Enter starts."""

    BINDINGS: ClassVar[list[BindingType]] = bindings(begin_recording, leave_out, no_recording)
    DEFAULT_CSS = """
    BeginRecordingScreen {
        #dialog-text { padding: 1 1 0 1; }
        #recording-shares { height: 6; margin-top: 1; }
        #recording-end { height: 1; padding: 0 1; margin-top: 1; }
        #recording-end Static { width: auto; margin-right: 1; }
        #recording-limit { width: 1fr; }
        #recording-note { height: auto; padding: 0 1; margin-bottom: 1; color: $text-error; }
    }
    """

    def __init__(self, folder: Path, room_bytes: int | None, left_out: frozenset[str]) -> None:
        """Record into `folder`, on a disk with this much room (None: unknown).

        `left_out` are the types that were left out the last time.
        """
        super().__init__()
        self._folder = folder
        self._room_bytes = room_bytes
        self.left_out: frozenset[str] = left_out & frozenset(HEAVY_TYPES)
        self._note = ""
        """What is wrong with the limit that was typed."""

    def compose(self) -> ComposeResult:
        """The words above the shares and the field."""
        with Vertical(id="dialog"):
            yield Static(id="dialog-text", markup=False)
            yield Rows(header=False, id="recording-shares")
            with Horizontal(id="recording-end"):
                yield Static(id="recording-label", markup=False)
                yield Field(id="recording-limit", compact=True, select_on_focus=False)
            yield Static(id="recording-note", markup=False)
            yield KeyBar()

    def on_mount(self) -> None:
        """Measure every topic as long as the dialog is there."""
        self.deck.feed.measure_all(True)
        self.query_one(Rows).focus()
        self.redraw()
        self.set_interval(LOOK_S, self.redraw)

    def on_unmount(self) -> None:
        """Measure only what the screen below needs."""
        self.deck.feed.measure_all(False)

    @property
    def chosen(self) -> str:
        return next((rows.chosen for rows in self.query(Rows)), "")

    def toggle(self) -> None:
        """Leave out the chosen type, or record it."""
        self.left_out ^= {self.chosen} - {""}
        self.redraw()
        self.refresh_bindings()

    def begin(self) -> None:
        """Answer with what is wished, unless the limit cannot be read."""
        field = self.query_one("#recording-limit", Input)
        try:
            limit = read_limit(field.value)
        except ValueError as error:
            self._note = str(error)
            self.redraw()
            field.focus()
        else:
            self.dismiss(RecordingWish(self._folder, self.left_out, limit))

    @on(Rows.Opened)
    def _clicked_twice(self, message: Rows.Opened) -> None:
        message.stop()
        self.toggle()

    @on(Rows.Highlighted)
    def _chosen_changed(self, message: Rows.Highlighted) -> None:
        message.stop()
        self.refresh_bindings()

    @on(Input.Changed)
    def _typed(self, message: Input.Changed) -> None:
        message.stop()
        # While it is being typed, nothing is wrong yet.
        self._note = ""
        self.redraw()

    def title_words(self) -> str:
        return _("Record what?")

    def redraw(self) -> None:
        """Show the current rates in the current language."""
        super().redraw()
        found = self._shares()
        columns = [Column("", 1), Column("", 27), Column(""), Column("", 13, right=True)]
        together = Cell(_("Together")), Cell(""), Cell(_a_minute(total_rate(found, self.left_out)))
        self.query_one(Rows).show(columns, [*map(self._row, found), Row("", (Cell(""), *together))])
        label = self.query_one("#recording-label", Static)
        if label.content != (words := _("End after")):
            label.update(words)
        field = self.query_one("#recording-limit", Input)
        field.placeholder = _("10 min, 500 MB; empty: when you end it")
        self.query_one("#recording-note", Static).update(self._note)

    def words(self) -> Content:
        """Return where it goes, and for how long there is room."""
        room = self._room_bytes
        rate = total_rate(self._shares(), self.left_out)
        free = _("unknown") if room is None else size_words(room)
        lines = [
            _("Into {folder}").format(folder=plain(str(self._folder), LONGEST)),
            _("Room on this disk: {size}").format(size=free),
        ]
        if room is not None and rate:
            enough = _("enough for {length}").format(length=_long_words(room / rate))
            lines[-1] += f", {enough}"
        return Content("\n").join(map(Content, lines))

    def _shares(self) -> tuple[RecordingShare, ...]:
        update = self.deck.feed.update
        return shares(() if update is None else update.topics)

    def _row(self, share: RecordingShare) -> Row:
        out = share.type_name in self.left_out
        mark = " " if share.type_name == OTHERS else "○" if out else "✓"
        look = "dim" if out or not share.topics else ""
        rate = UNKNOWN if not share.topics else _a_minute(share.bytes_per_s)
        cells = (mark, _(NAMES[share.type_name]), _topic_words(share.topics), rate)
        return Row(share.type_name, tuple(Cell(text, look) for text in cells))


def _long_words(seconds: float) -> str:
    """Return `3:07`, or how many days if it is more than two."""
    days = int(seconds / DAY_S)
    if days < DAYS_FROM:
        return length_words(seconds)
    return ngettext("{n} day", "{n} days", days).format(n=days)


def _a_minute(bytes_per_s: float | None) -> str:
    if bytes_per_s is None:
        return _("measuring…")
    return _("{size}/min").format(size=size_words(bytes_per_s * MINUTE_S))


def _topic_words(topics: tuple[str, ...]) -> str:
    """Return the name of the only topic, or how many there are."""
    if not topics:
        return UNKNOWN
    if len(topics) == 1:
        return plain(topics[0], LONGEST)
    return ngettext("{n} topic", "{n} topics", len(topics)).format(n=len(topics))
