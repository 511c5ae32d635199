"""The base of all panels, and what they read of an update: rows, troubles, other types, joints."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, ClassVar

from rich.cells import cell_len
from textual.app import ComposeResult
from textual.containers import Vertical
from textual.content import Content
from textual.visual import VisualType
from textual.widget import Widget

from graph.data import GraphUpdate, Sample, TopicRow, Trouble
from text.i18n import _
from text.plain import plain
from tui.faults import report_fault
from tui.widgets.drawing import Placeholder

ALWAYS = 1_000_000
CORNERS, SIDES = 2, 6
"""Cells of the upper edge that a title cannot use, without and with edges at the sides."""


class Panel(Vertical):
    """Base of the panels; a subclass composes its widget and feeds it in `show`."""

    DEFAULT_CSS = """
    Panel {
        width: 1fr; height: 1fr; padding: 0 1;
        border: round $primary 60%; border-title-color: $foreground; border-title-style: bold;
        &:focus-within { border: round $accent; }
        &.-failed > * { display: none; }
    }
    """

    view: ClassVar[type[Widget]] = Widget
    """Made for it, unless `compose` says more."""
    title: ClassVar[str] = ""
    """Marked by `N_`."""
    least: ClassVar[int] = 2
    """Rows within the frame below which the panel is useless."""
    weight: ClassVar[int] = 2
    """Its share of the remaining rows."""
    across_below: ClassVar[int] = 0
    """Width of the grid below which the panel has a row to itself."""

    _source = ""
    _pages: Sequence[str] = ()
    _fault = ""
    """Shown in place of the widget while it fails."""

    def compose(self) -> ComposeResult:
        yield self.view()

    def on_mount(self) -> None:
        self._entitle()

    def name_source(self, topic: str) -> None:
        if topic != self._source:
            self._source = topic
            self._entitle()

    def name_page(self, *words: str) -> None:
        """Show in the title that there are more pages, using the first of `words` that fits."""
        if words != self._pages:
            self._pages = words
            self._entitle()

    def on_resize(self) -> None:
        self._entitle()

    def _entitle(self) -> None:
        source = f"← {self._source}" if self._source else ""
        name = plain(" ".join(filter(None, (_(self.title), source))))
        room = self.outer_size.width - (SIDES if self.styles.border_left[0] else CORNERS)
        # An enlarged panel is alone, whatever page it stands on.
        pages = () if self.has_class("-maximized") else self._pages
        titles = [f"{name} {plain(words)}" for words in pages] or [name]
        fits = (title for title in titles if cell_len(title) <= room)
        self.border_title = Content(next(fits, titles[-1]))

    def useful(self, rows: int) -> int:
        """Return of how many of these rows it has any use."""
        return rows

    def watched(self) -> set[str]:
        """Return the topics whose newest message is needed."""
        return set()

    def pictures(self) -> set[str]:
        """Return the topics of which it shows the pictures now."""
        return set()

    def kept(self) -> set[str]:
        """Return the watched topics that are needed even while another tab is in front."""
        return set()

    def followed(self) -> set[str]:
        """Return the topics of which every message is needed."""
        return set()

    def show(self, update: GraphUpdate) -> None:
        """Show the new values, or why there are none."""
        raise NotImplementedError

    def keep(self, update: GraphUpdate) -> None:
        self.show(update)

    def take(self, update: GraphUpdate, *, seen: bool = True) -> None:
        """Show the update; if that fails, say so until an update can be shown again.

        While another tab is in front, only values that will be needed later are taken in.
        """
        if not seen and update.samples.keys().isdisjoint(self.followed() | self.kept()):
            return
        try:
            (self.show if seen else self.keep)(update)
        except Exception as error:  # noqa: BLE001 - raised again where faults are not isolated
            self.show_fault(report_fault(self, error))
        else:
            self.show_fault("")

    @property
    def failed(self) -> bool:
        """Whether an error message is shown in place of the widget."""
        return bool(self._fault)

    def show_fault(self, words: str) -> None:
        """Show an error message in place of the widget; an empty text means it works again."""
        if words != self._fault:
            self._fault = words
            self.set_class(bool(words), "-failed")
            self.refresh(layout=True)

    def render(self) -> VisualType:
        """Draw the background of the widget, which is visible while the widget fails."""
        return Content(self._fault) if self._fault else super().render()

    def on_language_changed(self) -> None:
        self._entitle()


def row_of(update: GraphUpdate, topic: str) -> TopicRow | None:
    return next((row for row in update.topics if row.name == topic), None)


def is_published(update: GraphUpdate, topic: str) -> bool:
    row = row_of(update, topic)
    return row is not None and row.publishers > 0


def newest(update: GraphUpdate, topic: str) -> Sample | None:
    samples = update.samples.get(topic)
    return samples[-1] if samples else None


def trouble_of(update: GraphUpdate, topic: str) -> tuple[Trouble | None, str, float | None]:
    row = row_of(update, topic)
    if row is None:
        return Trouble.NO_PUBLISHER, topic, None
    # The headline already says that nobody is there, or that nothing arrives.
    if row.trouble in {None, Trouble.NO_PUBLISHER, Trouble.QUIET} or not row.detail:
        return row.trouble, topic, row.age_s
    # Not needed for the first frame.
    from tui.widgets.trouble import advice

    return row.trouble, f"{topic}: {advice(row)[1]}", row.age_s


def first_published(update: GraphUpdate, topics: Iterable[str]) -> str:
    """Return the first topic that somebody publishes, otherwise the first of all."""
    names = list(topics)
    return next((name for name in names if is_published(update, name)), names[0])


LONGEST = 200


def other_type(sample: Sample | None, awaited: str) -> Placeholder | None:
    """Return the received and the expected type; None if they are the same, or nothing arrives."""
    if sample is None or sample.type_name == awaited:
        return None
    words = _("{topic}: {type} comes; expected: {awaited}").format(
        topic=sample.topic, type=_short(sample.type_name), awaited=_short(awaited)
    )
    return Placeholder(_("messages arrive, but of another type"), plain(words, LONGEST))


def _short(type_name: str) -> str:
    return type_name.replace("/msg/", "/")


TYPE = "sensor_msgs/msg/JointState"
ANOTHER_S = 2.0
"""A readable message counts for this long: two publishers may alternate."""


def has_joints(value: Mapping[str, Any], joints: Iterable[str]) -> bool:
    """Whether a sensor_msgs/JointState is about any of these joints."""
    return not set(joints).isdisjoint(map(str, value.get("name", ())))


def joint_number(value: Mapping[str, Any], array: str, joint: str) -> float:
    """What an array of a JointState, such as `position`, says of a joint; nan if it does not."""
    names, numbers = [str(name) for name in value.get("name", ())], value.get(array, ())
    at = names.index(joint) if joint in names else len(numbers)
    return float(numbers[at]) if at < len(numbers) else math.nan


class Joints:
    """Messages of a JointState topic that should be about these joints."""

    def __init__(self, topic: str, awaited: Sequence[str]) -> None:
        """Pass in `awaited` the joints of which at least one must be present."""
        self._topic, self._awaited = topic, tuple(awaited)
        self._read_s = -math.inf
        self._other: Sample | None = None

    def hear(self, sample: Sample, *, read: bool) -> None:
        if read:
            self._read_s, self._other = sample.received_s, None
        elif not 0.0 <= sample.received_s - self._read_s < ANOTHER_S:
            self._other = sample

    @property
    def placeholder(self) -> Placeholder | None:
        sample = self._other
        if sample is None:
            return None
        if (wrong := other_type(sample, TYPE)) is not None:
            return wrong
        found = sample.value.get("name")
        names = plain(", ".join(map(str, found)), LONGEST) if isinstance(found, (list, tuple)) else ""
        if not names:
            came = _("{topic}: received no joint names").format(topic=self._topic)
        else:
            came = _("{topic}: received {names}").format(topic=self._topic, names=names)
        awaited = _("expected: {names}").format(names=", ".join(self._awaited))
        return Placeholder(_("messages arrive, but with other joint names"), f"{came}; {awaited}")
