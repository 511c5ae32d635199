"""One topic: its type and figures, and its newest message, a picture, or its endpoints."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from rich.cells import cell_len, chop_cells
from textual import getters
from textual.app import ComposeResult
from textual.containers import Vertical
from textual.content import Content
from textual.widget import Widget
from textual.widgets import Static

from graph.data import Sample, TopicRow, Trouble
from graph.heavy_types import COMPRESSED_IMAGE, IMAGE
from graph.messages.yaml_text import is_cut, to_yaml
from graph.pictures.picture import Picture, ramp_colours
from graph.pictures.pixels import ImageError, UnknownEncodingError
from text.i18n import _, decimal, localized, ngettext
from text.plain import plain
from tui.echo.tree import EchoTree
from tui.topics.echo_filter import EchoFilter
from tui.topics.endpoints import TopicEndpoints
from tui.topics.table import age_text, bandwidth_text, hz_text
from tui.widgets.figures import count_text, seconds_text
from tui.widgets.image_view import ImageScale, ImageView
from tui.widgets.trouble import advice, names, no_data_words
from tui.widgets.working import Working

LONGEST_ARRAY = 2000
"""Elements of an array that are copied: the clipboard of a terminal (OSC 52) is small."""


class TopicHead(Static):
    """Name and type, figures and endpoints; on a low screen the first line of figures only.

    A name that is longer than a line continues in the next: it is shown in full nowhere else.
    """

    DEFAULT_CSS = """
    TopicHead {
        height: auto; min-height: 1; width: 1fr; background: $panel; color: $foreground;
        text-wrap: nowrap; text-overflow: ellipsis;
    }
    """
    _texts: tuple[str, str, tuple[str, ...], str] = ("", "", (), "")

    def show(self, name: str, type_name: str, figures: Sequence[str], below: str) -> None:
        texts = (plain(name), plain(type_name), tuple(figures), below)
        if texts != self._texts:
            self._texts = texts
            self.on_resize()

    def on_resize(self) -> None:
        name, type_name, parts, below = self._texts
        width = max(1, self.size.width)
        *above, last = chop_cells(name, width) or [""]
        lines = [Content.styled(part, "bold") for part in above]
        lines.append(Content.assemble((last, "bold"), "  ", (type_name, "dim")))
        more = [Content(text) for text in (*packed(parts, width), below) if text]
        is_low = self.screen.has_class("-low") or self.screen.has_class("-flat")
        content = Content("\n").join([*lines, *(more[:1] if is_low else more)])
        if content != self.content:
            self.update(content)


class TopicDetail(Vertical, Working):
    """Shows what is known about one topic; the screen passes it row, message and picture."""

    DEFAULT_CSS = """
    TopicDetail { width: 1fr; height: 1fr; }
    TopicDetail > ImageView, TopicDetail > TopicEndpoints { display: none; }
    TopicDetail.-picture > ImageView { display: block; }
    TopicDetail.-picture > EchoTree { display: none; }
    TopicDetail.-endpoints > TopicEndpoints { display: block; }
    TopicDetail.-endpoints > EchoTree, TopicDetail.-endpoints > ImageView { display: none; }
    """

    def __init__(self) -> None:
        super().__init__()
        self._row: TopicRow | None = None
        self.sample: Sample | None = None
        self._newest: Sample | None = None
        """The newest message, whether or not it matches the expression."""

    def compose(self) -> ComposeResult:
        yield TopicHead()
        yield EchoFilter()
        yield EchoTree()
        yield ImageView()
        yield TopicEndpoints()

    echo: getters.query_one[EchoTree] = getters.query_one(EchoTree)
    filter = getters.query_one(EchoFilter)
    picture = getters.query_one(ImageView)
    endpoints = getters.query_one(TopicEndpoints)

    @property
    def front(self) -> Widget:
        if self.as_endpoints:
            return self.endpoints
        return self.picture if self.as_picture else self.echo

    def fitting(self, samples: Sequence[Sample]) -> Sample | None:
        """Return the newest of these to be shown, if there is one; all of them are counted."""
        if samples:
            self._newest = samples[-1]
        return self.filter.fitting(samples)

    def filter_anew(self) -> Sample | None:
        """Return the newest message if it is to be shown; otherwise hide it."""
        found = self.filter.fitting(() if self._newest is None else (self._newest,))
        if found is None and not self.filter.is_wrong:
            self.sample = None
            self.say()
        return found

    def show_topic(self, row: TopicRow | None) -> None:
        """Show the current state of the topic; another topic starts without a message."""
        if row is None or self._row is None or row.name != self._row.name:
            self.sample = self._newest = None
            self.show_as_picture(False)
            # The picture of another topic must not stay there until a new one arrives.
            self.picture.show_words("")
            self.filter.show_topic("" if row is None else row.name)
        self._row = row
        self.say()

    def show_message(self, sample: Sample) -> None:
        resized = self.sample is None or self.sample.size_bytes != sample.size_bytes
        self.sample = sample
        if resized:
            self.say()
        self.echo.show_message(sample.topic, sample.value)

    def show_picture(self, sample: Sample, is_wanted: Callable[[], bool]) -> None:
        """Show this image once it is decoded, if it is still wanted then, or why it cannot be shown."""

        def show(picture: Picture) -> None:
            if is_wanted():
                self._put(picture)

        def refuse(error: ImageError) -> None:
            if is_wanted():
                self._refuse(sample, error)

        self.picture.read(sample, show, refuse)

    def _put(self, picture: Picture) -> None:
        if picture.is_empty_depth:
            words = _("no reading is a distance: each is NaN, infinite or 0")
            self.picture.show_words(_("no valid depth"), words)
            return
        size = f"{plain(picture.encoding, LONGEST)} {picture.width}×{picture.height}"
        scale = None
        if picture.range_m is not None:
            near, far = (_("{n} m").format(n=decimal(f"{metres:g}")) for metres in picture.range_m)
            first = _("near {distance}").format(distance=near)
            scale = ImageScale(first, _("{distance} far").format(distance=far), ramp_colours())
        self.picture.show(picture.rgb, size, scale, hz_text(self._row.hz if self._row else None))

    def _refuse(self, sample: Sample, error: ImageError) -> None:
        headline = _("this picture cannot be shown")
        if isinstance(error, UnknownEncodingError):
            words = _("pictures of the encoding {encoding} cannot be shown")
            headline = words.format(encoding=plain(str(sample.value.get("encoding")), LONGEST))
        self.picture.show_words(headline, localized(error.words))

    def copy_message(self) -> None:
        message = self.echo.message
        if message is None:
            self.notify(_("There is no message to copy."), severity="warning", markup=False)
            return
        text = to_yaml(message, most=LONGEST_ARRAY)
        self.app.copy_to_clipboard(text)
        words = _("Copied as YAML: {size}.").format(size=size_text(len(text.encode())))
        if is_cut(message, LONGEST_ARRAY):
            words += " " + _("Long arrays were cut.")
        self.notify(words, markup=False)

    @property
    def as_picture(self) -> bool:
        return self.has_class("-picture")

    def show_as_picture(self, picture: bool) -> None:
        self.set_class(picture, "-picture")

    @property
    def as_endpoints(self) -> bool:
        return self.has_class("-endpoints")

    def show_as_endpoints(self, endpoints: bool) -> None:
        if endpoints == self.as_endpoints:
            return
        had_focus = self.front.has_focus
        self.set_class(endpoints, "-endpoints")
        if endpoints:
            self.endpoints.show(self._row)
        if had_focus and self.front.can_focus:
            self.front.focus()

    def on_language_changed(self) -> None:
        self.say()

    def say(self) -> None:
        head, row = self.query_one(TopicHead), self._row
        if self.as_endpoints:
            self.endpoints.show(row)
        if row is None:
            head.show(_("no topic is selected"), "", (), "")
            self.echo.show_words("", "")
            return
        headline, way_out = advice(row)
        size = None if self.sample is None else self.sample.size_bytes
        state = figures(row, size)
        if self.echo.paused:
            state = [_("PAUSED"), *state]
        types = " | ".join(row.type_names)
        if self.sample is not None:
            # Silence is shown in the figures, and is normal for most topics.
            quiet = row.trouble is Trouble.QUIET
            trouble = "" if quiet else " ".join(filter(None, (headline, way_out)))
            head.show(row.name, types, state, trouble or ends(row))
            return
        head.show(row.name, types, state, ends(row))
        self._say_why_empty(row.name, headline, way_out)

    def _say_why_empty(self, topic: str, headline: str, way_out: str) -> None:
        waiting = _("waiting for a message"), _("It is shown as soon as one comes.")
        words = (headline, way_out) if headline else waiting
        if self.filter.in_force and (self._newest is not None or not headline):
            words = self.filter.why_none()
        self.echo.show_words(topic, *words)
        if self.as_picture:
            self.picture.show_words(*words)


KILO = 1000
BETWEEN = " · "
LONGEST = 200
OURSELVES = "Deck"


def figures(row: TopicRow, size_bytes: int | None) -> list[str]:
    if row.pictures_from:
        parts = [_("pictures from {topic}").format(topic=plain(row.pictures_from, LONGEST))]
    elif not row.measured:
        parts = [_("not measured: Deck is not subscribed")]
    elif row.trouble is Trouble.QUIET and row.age_s is not None:
        parts = [no_data_words(row.age_s)]
    elif row.hz is None:
        parts = [_("no rate yet: it takes two messages")] if row.trouble is None else []
    else:
        parts = [
            f"{hz_text(row.hz)} {_('Hz')}",
            bandwidth_text(row.bytes_per_s),
            _("age {time}").format(time=age_text(row.age_s)),
            _("jitter {time}").format(time=seconds_text(row.jitter_s)),
            _("latency {time}").format(time=seconds_text(row.latency_s)),
            _("lost {n}").format(n=count_text(row.lost)),
        ]
    if size_bytes is not None:
        parts.append(_("{size} a message").format(size=size_text(size_bytes)))
    return parts


def packed(parts: Sequence[str], width: int) -> list[str]:
    """The parts in lines of at most `width` cells, each line as full as possible."""
    lines: list[str] = []
    for part in parts:
        if lines and cell_len(lines[-1]) + len(BETWEEN) + cell_len(part) <= width:
            lines[-1] += BETWEEN + part
        else:
            lines.append(part)
    return lines


def size_text(size_bytes: int) -> str:
    if size_bytes < KILO:
        return _("{n} B").format(n=size_bytes)
    if size_bytes < KILO * KILO:
        return _("{n} kB").format(n=decimal(f"{size_bytes / KILO:.1f}"))
    return _("{n} MB").format(n=decimal(f"{size_bytes / KILO / KILO:.1f}"))


def ends(row: TopicRow) -> str:
    publishers = names(row.published_by, counted=True)
    if not publishers and (row.publishers or not row.own_publishers):
        publishers = ngettext("{n} publisher", "{n} publishers", row.publishers).format(n=row.publishers)
    if row.own_publishers:
        publishers = f"{publishers}, {OURSELVES}" if publishers else OURSELVES
    subscribers = names(row.subscribed_by, counted=True) or ngettext(
        "{n} subscriber", "{n} subscribers", row.subscribers
    ).format(n=row.subscribers)
    return f"{publishers} → {subscribers}"


def carries_images(row: TopicRow | None) -> bool:
    return row is not None and not {IMAGE, COMPRESSED_IMAGE}.isdisjoint(row.type_names)


def is_image(sample: Sample) -> bool:
    return sample.type_name in {IMAGE, COMPRESSED_IMAGE}
