"""One topic: what it is, and its newest message as a tree or as a picture."""

from __future__ import annotations

from typing import TYPE_CHECKING

from textual.containers import Vertical
from textual.content import Content
from textual.widget import Widget

from graph.data import Trouble
from tui.i18n import _
from tui.widgets.echo_tree import EchoTree
from tui.widgets.image_view import ImageView
from tui.widgets.plain import plain
from tui.widgets.topic_words import advice, ends, figures

if TYPE_CHECKING:
    from textual.app import ComposeResult

    from graph.data import Sample, TopicRow
    from tui.widgets.half_blocks import Pixels


class TopicHead(Widget):
    """Name and type, rates, and who is on the topic: three lines, or two."""

    DEFAULT_CSS = """
    TopicHead {
        height: auto; max-height: 3; width: 1fr; background: $panel; color: $foreground;
        text-wrap: nowrap; text-overflow: ellipsis;
    }
    """

    def __init__(self) -> None:
        super().__init__()
        self._lines: tuple[str, str, str, str] = ("", "", "", "")

    def show(self, name: str, type_name: str, state: str, below: str) -> None:
        """Show these texts, drawn only if one of them is new."""
        lines = (plain(name), plain(type_name), state, below)
        if lines != self._lines:
            other_height = len(list(filter(None, lines))) != len(list(filter(None, self._lines)))
            self._lines = lines
            self.refresh(layout=other_height)

    def render(self) -> Content:
        """Draw the lines."""
        name, type_name, state, below = self._lines
        lines = [Content.assemble((name, "bold"), "  ", (type_name, "dim"))]
        lines += [Content(text) for text in (state, below) if text]
        return Content("\n").join(lines)


class TopicDetail(Vertical):
    """Shows what is known of one topic; the screen tells it row, message and picture."""

    DEFAULT_CSS = """
    TopicDetail { width: 1fr; height: 1fr; }
    TopicDetail > ImageView { display: none; }
    TopicDetail.-picture > ImageView { display: block; }
    TopicDetail.-picture > EchoTree { display: none; }
    """

    def __init__(self, *, id: str | None = None) -> None:
        super().__init__(id=id)
        self._row: TopicRow | None = None
        self._sample: Sample | None = None

    def compose(self) -> ComposeResult:
        """The head above tree and picture, of which one is shown."""
        yield TopicHead()
        yield EchoTree()
        yield ImageView()

    @property
    def echo(self) -> EchoTree:
        """The message as a tree."""
        return self.query_one(EchoTree)

    @property
    def picture(self) -> ImageView:
        """The message as a picture."""
        return self.query_one(ImageView)

    @property
    def sample(self) -> Sample | None:
        """The newest message."""
        return self._sample

    def show_topic(self, row: TopicRow | None) -> None:
        """Show how the topic is now; another topic than before begins without a message."""
        if row is None or self._row is None or row.name != self._row.name:
            self._sample = None
            self.show_as_picture(False)
        self._row = row
        self._say()

    def show_message(self, sample: Sample) -> None:
        """Show a new message of the topic that is shown."""
        resized = self._sample is None or self._sample.size_bytes != sample.size_bytes
        self._sample = sample
        if resized:
            self._say()
        self.echo.show(sample.topic, sample.value)

    def show_picture(self, rgb: Pixels, caption: str) -> None:
        """Show the newest message as a picture."""
        self.picture.show(rgb, caption)

    def show_no_picture(self, headline: str, detail: str = "") -> None:
        """Say why the newest message is no picture."""
        self.picture.show_words(headline, detail)

    @property
    def as_picture(self) -> bool:
        """Whether the picture is in front of the tree."""
        return self.has_class("-picture")

    def show_as_picture(self, picture: bool) -> None:
        """Bring the picture to the front, or the tree."""
        if picture != self.as_picture:
            self.set_class(picture, "-picture")

    def relabel(self) -> None:
        """Draw again, after the language changed."""
        self._say()
        self.echo.relabel()

    def _say(self) -> None:
        head, row = self.query_one(TopicHead), self._row
        if row is None:
            head.show(_("no topic is chosen"), "", "", "")
            self.echo.show_words("", "")
            return
        headline, way_out = advice(row)
        size = None if self._sample is None else self._sample.size_bytes
        state = figures(row, size)
        if self.echo.paused:
            state = f"{_('PAUSED')} · {state}"
        types = " | ".join(row.type_names)
        if self._sample is not None:
            # That it is quiet is said by the figures, and most topics may be.
            quiet = row.trouble is Trouble.QUIET
            trouble = "" if quiet else " ".join(filter(None, (headline, way_out)))
            head.show(row.name, types, state, trouble or ends(row))
            return
        head.show(row.name, types, state, ends(row))
        self._say_why_empty(row.name, headline, way_out)

    def _say_why_empty(self, topic: str, headline: str, way_out: str) -> None:
        waiting = _("waiting for a message"), _("It is shown as soon as one comes.")
        words = (headline, way_out) if headline else waiting
        self.echo.show_words(topic, *words)
        if self.as_picture:
            self.picture.show_words(*words)
