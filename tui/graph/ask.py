"""Sending requests to the graph: a form, and the answers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

from textual.containers import Container, Vertical
from textual.widgets import Static

from text.i18n import _
from tui import clock
from tui.echo.tree import EchoTree
from tui.graph.links import GraphLinks
from tui.graph.pane import GraphPane
from tui.widgets.name_head import NameHead
from tui.widgets.rows import Rows
from tui.yaml_form.actions import submit_form
from tui.yaml_form.form import YamlForm

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from textual.app import ComposeResult
    from textual.timer import Timer
    from textual.widget import Widget

    from tui.widgets.rows import Column, Row

SETTLED_S = 0.12
"""How long a choice must stand before its form is created: that imports its package."""
TICK_S = 0.5


class AskPane(GraphPane):
    """Form beside the answers, or above them on a narrow screen.

    A subclass supplies the nodes involved (`links`), the earlier requests (`asked`), and the
    outcome of the chosen one (`answer`).
    """

    submit_title: ClassVar[str] = ""
    DEFAULT_CSS: ClassVar[str] = """
    AskPane {
        .ask-body { height: 1fr; width: 1fr; layout: vertical; }
        .ask-left, .ask-right { height: 1fr; width: 1fr; }
        .ask-title { height: 1; width: 1fr; background: $panel; color: $text-muted; padding: 0 1; }
        GraphLinks { height: auto; max-height: 3; }
        .asked { height: auto; max-height: 30%; border-top: solid $panel; }
        YamlForm { min-height: 3; }
        EchoTree { min-height: 1; }
    }
    """

    def __init__(self, *, id: str | None = None) -> None:
        super().__init__(id=id)
        self._texts: dict[str, str] = {}
        """Maps a name to the text that was in its form."""
        self._could_cancel = False
        self._form_for = ""
        self._settling: Timer | None = None

    def compose(self) -> ComposeResult:
        """Head, nodes, form; answer, and the earlier requests."""
        yield NameHead()
        with Container(classes="ask-body"):
            with Vertical(classes="ask-left"):
                yield GraphLinks()
                yield YamlForm(submit_title=self.submit_title, type_is_given=True)
                yield from self.compose_more()
            with Vertical(classes="ask-right"):
                yield Static(classes="ask-title", markup=False)
                yield EchoTree()
                yield Rows(header=False, classes="asked")

    def compose_more(self) -> ComposeResult:
        """Yield further widgets below the form."""
        yield from ()

    def on_mount(self) -> None:
        """Keep the waiting time up to date."""
        self.set_interval(TICK_S, self.tick)

    @property
    def form(self) -> YamlForm:
        return self.query_one(YamlForm)

    @property
    def echo(self) -> EchoTree:
        return self.query_one(EchoTree)

    @property
    def asked_rows(self) -> Rows:
        """The requests sent so far."""
        return self.query_one(".asked", Rows)

    @property
    def submit_key(self) -> str:
        return self.deck.keys_of(submit_form)[0]

    def type_names(self) -> tuple[str, ...]:
        """Return the types of what is shown; empty if it has left the graph."""
        raise NotImplementedError

    def links(self) -> Sequence[Row]:
        """Return rows that link to its type and its nodes."""
        raise NotImplementedError

    def asked(self) -> tuple[Sequence[Column], Sequence[Row]]:
        """Return the requests, the newest first."""
        raise NotImplementedError

    def answer(self) -> tuple[str, str, Mapping[str, Any] | tuple[str, str]]:
        """Return a title, what the tree belongs to, and the tree or the words in its place."""
        raise NotImplementedError

    def ask(self, value: Mapping[str, Any]) -> None:
        raise NotImplementedError

    @property
    def can_cancel(self) -> bool:
        raise NotImplementedError

    def cancel(self) -> None:
        """Cancel the request in progress, the chosen one if possible."""
        raise NotImplementedError

    @property
    def can_forget(self) -> bool:
        """Whether the chosen request can be removed from the list."""
        return False

    def forget(self) -> None:
        """Remove the chosen request from the list."""

    @property
    def is_waiting(self) -> bool:
        return self.can_cancel

    def tick(self) -> None:
        """Update the waiting time while a request is in progress."""
        if self.is_waiting:
            self.redraw()

    @property
    def is_settling(self) -> bool:
        """Whether its form is still to be loaded."""
        return self._settling is not None

    def show_name(self, name: str) -> None:
        """Show another name, and load its form once the choice stands."""
        if name != self.name_shown:
            if self._settling is not None:
                self._settling.stop()
            self._settling = self.set_timer(SETTLED_S, self.load_form)
        super().show_name(name)

    def ros2_line(self, type_name: str, value: Mapping[str, Any]) -> str:
        """Return what sends this request, as a command line of `ros2`."""
        raise NotImplementedError

    def ros2_info(self) -> str:
        """Return what tells of the name, while the form cannot be sent."""
        raise NotImplementedError

    def ros2_command(self) -> str:
        """Return what sends the form, or tells of the name while there is nothing to be sent."""
        types, value = self.type_names(), self.form.value
        if types and value is not None and self._form_for == self.name_shown:
            return self.ros2_line(types[0], value)
        return self.ros2_info() if self.name_shown else ""

    def load_form(self) -> None:
        """Replace the previous form with that of the current name."""
        self._settling = None
        if self._form_for:
            self._texts[self._form_for] = self.form.text
        types = self.type_names()
        if types and self.name_shown != self._form_for:
            self._form_for = self.name_shown
            self.form.load(types[0], self._texts.get(self.name_shown))

    def redraw(self) -> None:
        if not self.name_shown or not self.is_mounted:
            return
        types = self.type_names()
        told = [] if types else [_("nobody serves it any more")]
        if len(types) > 1:
            told = [_("Nodes use different types for it; Deck uses {type}.").format(type=types[0])]
        self.query_one(NameHead).show(self.name_shown, *told)
        self.query_one(GraphLinks).show_links(self.links())
        columns, rows = self.asked()
        self.asked_rows.display = bool(rows)
        self.asked_rows.show(columns, rows)
        self._show_answer()
        if self.can_cancel != self._could_cancel:
            self._could_cancel = self.can_cancel
            self.screen.refresh_bindings()

    def relabel(self) -> None:
        """Redraw in the current language."""
        self.form.relabel()
        self.redraw()

    def first(self) -> Widget:
        return self.form.editor

    def on_rows_highlighted(self, event: Rows.Highlighted) -> None:
        """Show the outcome of another request."""
        if event.rows is self.asked_rows:
            event.stop()
            self._show_answer()
            self.screen.refresh_bindings()

    def on_yaml_form_submitted(self, event: YamlForm.Submitted) -> None:
        event.stop()
        if self.deck.feed.graph is None:
            self.warn(_("no lesson is running"))
        elif self._form_for != self.name_shown or not self.type_names():
            self.warn(_("nobody serves it any more"))
        else:
            self.ask(event.value)
        self.redraw()

    def _show_answer(self) -> None:
        title, name, tree = self.answer()
        bar = self.query_one(".ask-title", Static)
        if bar.content != title:
            bar.update(title)
        if isinstance(tree, tuple):
            self.echo.show_words(name, *tree)
        else:
            self.echo.show(name, tree)


def now_s() -> float:
    """Return the clock for waiting times, in seconds."""
    return clock.now()
