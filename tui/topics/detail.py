"""One topic: its type and figures, and its newest message, a picture, or its endpoints."""

from __future__ import annotations

from collections.abc import Sequence

from rich.cells import chop_cells
from textual.app import ComposeResult
from textual.containers import Vertical
from textual.content import Content
from textual.geometry import Size
from textual.widget import Widget

from graph.data import Sample, TopicRow, Trouble
from graph.messages.yaml_text import is_cut, to_yaml
from text.i18n import _
from text.plain import plain
from tui.echo.tree import EchoTree
from tui.topics.echo_filter import EchoFilter
from tui.topics.endpoints import TopicEndpoints
from tui.topics.words import ends, figures, packed, size_text
from tui.widgets.image_view import ImageView
from tui.widgets.trouble import advice
from tui.widgets.working import Working

LONGEST_ARRAY = 2000
"""Elements of an array that are copied: the clipboard of a terminal (OSC 52) is small."""


class TopicHead(Widget):
    """Name and type, figures and endpoints: as many lines as there is room for.

    A name that is longer than a line continues in the next: it is shown in full nowhere else.
    """

    DEFAULT_CSS = """
    TopicHead {
        height: auto; width: 1fr; background: $panel; color: $foreground;
        text-wrap: nowrap; text-overflow: ellipsis;
    }
    """

    def __init__(self) -> None:
        super().__init__()
        self._texts: tuple[str, str, tuple[str, ...], str] = ("", "", (), "")

    def show(self, name: str, type_name: str, figures: Sequence[str], below: str) -> None:
        texts = (plain(name), plain(type_name), tuple(figures), below)
        if texts != self._texts:
            before = self._count()
            self._texts = texts
            self.refresh(layout=self._count() != before)

    def on_resize(self) -> None:
        self.refresh(layout=True)

    def get_content_height(self, container: Size, viewport: Size, width: int) -> int:
        """Return the lines that the figures take at this width, plus those above and below."""
        del container, viewport
        return self._count(width)

    def render(self) -> Content:
        name, type_name, parts, below = self._texts
        width = max(1, self.size.width)
        *above, last = chop_cells(name, width) or [""]
        lines = [Content.styled(part, "bold") for part in above]
        lines.append(Content.assemble((last, "bold"), "  ", (type_name, "dim")))
        lines += [Content(text) for text in (*packed(parts, width), below) if text]
        return Content("\n").join(lines)

    def _count(self, width: int | None = None) -> int:
        name, _type, parts, below = self._texts
        width = max(1, width or self.size.width)
        named = len(chop_cells(name, width)) or 1
        if self.screen.has_class("-low") or self.screen.has_class("-flat"):
            return named + 1
        return named + len(packed(parts, width)) + bool(below)


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

    def __init__(self, *, id: str | None = None) -> None:
        super().__init__(id=id)
        self._row: TopicRow | None = None
        self._sample: Sample | None = None
        self._newest: Sample | None = None
        """The newest message, whether or not it matches the expression."""

    def compose(self) -> ComposeResult:
        yield TopicHead()
        yield EchoFilter()
        yield EchoTree()
        yield ImageView()
        yield TopicEndpoints()

    @property
    def echo(self) -> EchoTree:
        return self.query_one(EchoTree)

    @property
    def filter(self) -> EchoFilter:
        return self.query_one(EchoFilter)

    @property
    def picture(self) -> ImageView:
        return self.query_one(ImageView)

    @property
    def endpoints(self) -> TopicEndpoints:
        return self.query_one(TopicEndpoints)

    @property
    def front(self) -> Widget:
        if self.as_endpoints:
            return self.endpoints
        return self.picture if self.as_picture else self.echo

    @property
    def sample(self) -> Sample | None:
        return self._sample

    def fitting(self, samples: Sequence[Sample]) -> Sample | None:
        """Return the newest of these to be shown, if there is one; all of them are counted."""
        if samples:
            self._newest = samples[-1]
        return self.filter.fitting(samples)

    def filter_anew(self) -> Sample | None:
        """Return the newest message if it is to be shown; otherwise hide it."""
        found = self.filter.fitting(() if self._newest is None else (self._newest,))
        if found is None and not self.filter.is_wrong:
            self._sample = None
            self.say()
        return found

    def show_topic(self, row: TopicRow | None) -> None:
        """Show the current state of the topic; another topic starts without a message."""
        if row is None or self._row is None or row.name != self._row.name:
            self._sample = self._newest = None
            self.show_as_picture(False)
            # The picture of another topic must not stay there until a new one arrives.
            self.picture.show_words("")
            self.filter.show_topic("" if row is None else row.name)
        self._row = row
        self.say()

    def show_message(self, sample: Sample) -> None:
        resized = self._sample is None or self._sample.size_bytes != sample.size_bytes
        self._sample = sample
        if resized:
            self.say()
        self.echo.show(sample.topic, sample.value)

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
        if picture != self.as_picture:
            self.set_class(picture, "-picture")

    @property
    def as_endpoints(self) -> bool:
        """Whether the endpoints are shown rather than message or picture."""
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
        size = None if self._sample is None else self._sample.size_bytes
        state = figures(row, size)
        if self.echo.paused:
            state = [_("PAUSED"), *state]
        types = " | ".join(row.type_names)
        if self._sample is not None:
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
