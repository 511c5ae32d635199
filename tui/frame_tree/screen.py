"""The tree of frames, what is wrong with it, and where one frame is in another."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import ClassVar

from textual import getters, on
from textual.app import ComposeResult
from textual.containers import Container, Vertical, VerticalScroll
from textual.content import Content
from textual.widgets import Input, Static

from graph.data import GraphUpdate
from graph.findings.finding import GraphFinding
from graph.frames.findings import findings_in
from graph.frames.tree import FrameTree, TreeLine
from text import ros2_words
from text.i18n import N_, _
from tui.actions import bindings
from tui.frame.screen import DeckScreen
from tui.frame_tree import cells, words
from tui.frame_tree.actions import FRAMES_ACTIONS
from tui.frame_tree.words import FramePair, FramePairs, pair_lines, pair_text, publisher_line
from tui.session.messages import GraphChanged, LanguageChanged, SessionChanged, StatusChanged
from tui.widgets.field import Field
from tui.widgets.rows import Cell, Column, Row, Rows

STATE, AGE = 11, 7
NARROW, WIDE = 18, 30
BETWEEN = "\0"
"""Between parent and frame in the key of a row: in no name."""


def key_of(line: TreeLine) -> str:
    return f"{line.parent}{BETWEEN}{line.frame}"


def frame_of(key: str) -> str:
    return key.partition(BETWEEN)[2]


class FrameTable(Rows):
    """One row for each frame below each of its parents."""

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        """Leave Enter to the screen, whose footer says what it does."""
        return False if action == "open" else super().check_action(action, parameters)

    def show_tree(self, lines: Sequence[TreeLine], looks: Mapping[str, str], relative_to: str, *, wide: bool) -> None:
        """Show the tree; one frame has been marked, `looks` are `warn`, `dim` or none for each."""
        columns = [
            Column(_("frame")),
            Column(_("rate"), STATE, right=True),
            Column(_("age"), AGE, right=True),
            Column(_("publisher"), WIDE if wide else NARROW),
        ]
        rows = [_row(line, looks.get(line.frame, ""), relative_to) for line in lines]
        self.show(columns, rows or [Row("", (Cell(_("nothing matches the filter"), "dim"),))])


def _row(line: TreeLine, look: str, relative_to: str) -> Row:
    marks = (" ◎" if line.frame == relative_to else "") + (" !" if look == "warn" else "")
    return Row(
        key_of(line),
        (
            Cell(cells.name(line) + marks, look),
            Cell(*cells.state(line)),
            Cell(*cells.age(line)),
            Cell(*cells.publisher(line)),
        ),
    )


WIDE_FROM = 160
"""Width of the screen from which on names of nodes have more room."""
MEANINGS = {"good": "$text-success", "bad": "$text-error", "": ""}


class FramesScreen(DeckScreen):
    """The tree; beside or below it a transform, and the findings."""

    tab: ClassVar[str] = "frames"
    about: ClassVar[str] = N_(
        "The tree of the frames on /tf and /tf_static: who publishes each, how often, how old it "
        "is. Where the frame at the cursor is, in metres and degrees, is shown relative to the "
        "root, or to the frame that Enter marks (◎). Below is what is wrong: frames that have "
        "fallen silent, two parents, loops, trees that nothing joins, clocks that differ; a ! "
        "stands beside each such frame, n goes from one to the next. A ? after a publisher: there "
        "are several, and the middleware does not say which of them it is."
    )
    parts: ClassVar[tuple[str, ...]] = ("FrameTable", "#frames-side")
    wants_frames = True
    measure_all = True
    measure_images = False
    BINDINGS: ClassVar = bindings(*FRAMES_ACTIONS)
    DEFAULT_CSS = """
    FramesScreen {
        #frames-empty { height: 1fr; padding: 1 2; color: $text-muted; }
        #frames-body { height: 1fr; layout: vertical; }
        #frames-tree { height: 3fr; }
        #frames-filter { width: 1fr; }
        #frames-side { height: 2fr; min-height: 10; }
        #frames-pair { height: auto; max-height: 6; padding: 0 1; background: $panel; }
        #frames-findings {
            height: 1fr; padding: 0 1; scrollbar-size-vertical: 1; scrollbar-gutter: stable;
        }
        #frames-findings > Static { height: auto; }
    }
    FramesScreen.-home, FramesScreen.-wide {
        #frames-body { layout: horizontal; }
        #frames-tree { width: 9fr; height: 1fr; }
        #frames-side { width: 5fr; min-width: 47; height: 1fr; border-left: solid $panel; }
        #frames-pair { max-height: 10; }
    }
    """

    AUTO_FOCUS: ClassVar[str] = "FrameTable"

    def __init__(self) -> None:
        super().__init__()
        self._update: GraphUpdate | None = None
        self.frame_tree: FrameTree = FrameTree(())
        self._lines: list[TreeLine] = []
        self.findings: list[GraphFinding] = []
        self._pairs = FramePairs()
        self._relative_to = ""
        """The frame that Enter has marked; empty for the root of the one at the cursor."""
        self.turned = False
        self._able = (False, False, False)
        """Whether a frame is chosen, and there is a finding, and a tree, to act on."""
        self._said: dict[str, list[tuple[str, str]]] = {}

    def compose_body(self) -> ComposeResult:
        yield Static(id="frames-empty", markup=False)
        with Container(id="frames-body"):
            with Vertical(id="frames-tree"):
                yield Field(id="frames-filter", compact=True, select_on_focus=False)
                yield FrameTable()
            with Container(id="frames-side"):
                yield Static(id="frames-pair", markup=False)
                with VerticalScroll(id="frames-findings"):
                    yield Static(markup=False)

    table = getters.query_one(FrameTable)
    filter: getters.query_one[Input] = getters.query_one("#frames-filter", Input)

    @property
    def chosen(self) -> str:
        return frame_of(self.table.chosen) if self.is_mounted and self._lines else ""

    @property
    def pair(self) -> FramePair | None:
        source = self.chosen
        if not source:
            return None
        target = self._relative_to or self.frame_tree.root_of(source)
        return self._pairs.find(*((source, target) if self.turned else (target, source)))

    def on_mount(self) -> None:
        self.table.focus()
        self._show()

    def on_session_changed(self, message: SessionChanged) -> None:
        del message
        if self.feed.session is not None:
            self._update, self._relative_to, self.turned = None, "", False
            self._pairs.clear()
        self._show()

    def on_status_changed(self, message: StatusChanged) -> None:
        del message
        if not self._lines:
            self._show()

    def on_graph_changed(self, message: GraphChanged) -> None:
        self._update = message.update
        self._pairs.take(message.update.frames)
        self._show()

    def on_language_changed(self, message: LanguageChanged) -> None:
        del message
        self._show()

    def on_resize(self) -> None:
        self.call_after_refresh(self._show)

    @on(FrameTable.Highlighted)
    def _cursor_moved(self) -> None:
        self.show_pair()
        self._show_findings()
        self.refresh_bindings()

    @on(Input.Changed, "#frames-filter")
    def _filter_changed(self) -> None:
        self._show()

    @on(Input.Submitted, "#frames-filter")
    def _filter_done(self) -> None:
        self.table.focus()

    def key_escape(self) -> None:
        self.filter.value = ""
        self.table.focus()

    @on(FrameTable.Opened)
    def _marked(self) -> None:
        self.relate()

    # Actions

    async def ros2_command(self) -> str:
        pair = self.pair
        return ros2_words.tf2_echo(pair.target, pair.source) if pair else ""

    def relate(self) -> None:
        self._relative_to = "" if self._relative_to == self.chosen else self.chosen
        self._show()

    def go_to_finding(self, step: int) -> None:
        """Go to the next frame that something is wrong with, or to the one before."""
        wrong = self._wrong
        keys = [key_of(line) for line in self._lines]
        places = [place for place, line in enumerate(self._lines) if line.frame in wrong]
        if not places:
            # It is about no frame of the tree, but about a topic or a header.
            self.query_one("#frames-findings").focus()
            return
        at = keys.index(self.table.chosen) if self.table.chosen in keys else -1
        beyond = [place for place in places[::step] if (place - at) * step > 0]
        self.table.choose(keys[beyond[0] if beyond else places[::step][0]])

    def copy_pair(self) -> None:
        text = pair_text(self.pair) if self.pair else ""
        if not text:
            self.notify(_("There is no transform to copy."), severity="warning", markup=False)
            return
        self.app.copy_to_clipboard(text)
        self.notify(text.partition("\n")[0], title=_("Copied"), markup=False)

    # Display

    @property
    def _wrong(self) -> frozenset[str]:
        return frozenset(frame for one in self.findings for frame in one.nodes)

    def _show(self) -> None:
        # Without its parts it is just being opened or closed.
        if not self.query("#frames-filter"):
            return
        update = self._update
        self.frame_tree = FrameTree(() if update is None else update.frames)
        self._lines, fitting = self._fitting()
        self.findings = [] if update is None else findings_in(update, self.frame_tree)
        if self._relative_to not in self.frame_tree.frames:
            self._relative_to = ""
        empty = not self.frame_tree.frames and not self.findings
        self.query_one("#frames-body").display = not empty
        note = self.query_one("#frames-empty", Static)
        note.display = empty
        if empty:
            note.update("\n".join(words.why_no_frames(self.deck, update)))
            return
        if self.focused is None:
            self.table.focus()
        self.filter.placeholder = _("filter: words of a frame or its publisher")
        looks = {line.frame: "" if line.frame in fitting else "dim" for line in self._lines}
        looks |= dict.fromkeys(self._wrong, "warn")
        wide = self.size.width >= WIDE_FROM
        self.table.show_tree(self._lines, looks, self._relative_to, wide=wide)
        self.show_pair()
        self._show_findings()
        able = (bool(self.chosen), bool(self.findings), bool(self.frame_tree.frames))
        if able != self._able:
            self._able = able
            self.refresh_bindings()

    def _fitting(self) -> tuple[list[TreeLine], frozenset[str]]:
        """Return what the filter leaves of the tree, and the frames in it that match themselves."""
        lines = self.frame_tree.lines()
        parts = self.filter.value.casefold().split()
        if not parts:
            return lines, self.frame_tree.frames
        fitting = frozenset(line.frame for line in lines if words.fits(line, parts))
        return self.frame_tree.lines(self.frame_tree.with_ancestors(fitting)), fitting

    def show_pair(self) -> None:
        pair = self.pair
        room = self.query_one("#frames-pair").scrollable_content_region.width
        lines = [_("no frame")] if pair is None else pair_lines(pair, room)
        heard = next((line.heard for line in self._lines if key_of(line) == self.table.chosen), ())
        if heard:
            recorded = self.feed.replay is not None
            lines.append(_("a recording does not say which node published it") if recorded else publisher_line(heard))
        looks = ["bold"] + [""] * len(lines)
        self._say("#frames-pair", list(zip(lines, looks, strict=False)))

    def _show_findings(self) -> None:
        room = self.query_one("#frames-findings").scrollable_content_region.width
        lines = words.finding_lines(self.findings, self.chosen, room)
        self._say("#frames-findings > Static", [(text, MEANINGS[look]) for text, look in lines])

    def _say(self, where: str, lines: list[tuple[str, str]]) -> None:
        """Update a text, each line with its style, only if it has changed: that costs a layout."""
        if self._said.get(where) != lines:
            self._said[where] = lines
            styled = [Content.styled(text, look) if look else Content(text) for text, look in lines]
            self.query_one(where, Static).update(Content("\n").join(styled))
