"""Sending requests to the graph: a form, and the answers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, ClassVar, TypeAlias

from textual import getters
from textual.app import ComposeResult
from textual.containers import Container, Vertical
from textual.widget import Widget
from textual.widgets import Static

from text.i18n import _
from tui.echo.tree import EchoTree
from tui.graph.index import GraphKind, GraphPlace
from tui.graph.pane import GraphLinks, GraphPane, heading, link, node_links
from tui.widgets.name_head import NameHead
from tui.widgets.rows import Column, Row, Rows
from tui.yaml_form.form import YamlForm

Answer: TypeAlias = "tuple[str, str, Mapping[str, Any] | tuple[str, str]]"


class AskPane(GraphPane):
    """Form beside the answers, or above them on a narrow screen.

    A subclass supplies the nodes involved (`ends`), the earlier requests (`asked`), and the outcome
    of the chosen one (`answer`).
    """

    submit_title: ClassVar[str] = ""
    calls_it: ClassVar[str] = ""
    """What is said of its clients, marked by `N_`."""
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

    def __init__(self, *, id: str) -> None:
        super().__init__(id=id)
        self._texts: dict[str, str] = {}
        self._could_cancel = False
        self._form_for = ""

    def compose(self) -> ComposeResult:
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
        yield from ()

    form = getters.query_one(YamlForm)
    asked_rows = getters.query_one(".asked", Rows)

    def ends(self) -> tuple[Sequence[str], Sequence[str], Sequence[str]] | None:
        """Return the types, the servers and the clients of what is shown; None if it has left the graph."""
        raise NotImplementedError

    def asked(self) -> tuple[Sequence[Column], Sequence[Row]]:
        """Return the requests, the newest first."""
        raise NotImplementedError

    def answer(self) -> Answer:
        """Return a title, what the tree belongs to, and the tree or the words in its place."""
        raise NotImplementedError

    def ask(self, type_name: str, value: Mapping[str, Any]) -> None:
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

    def ros2_line(self, type_name: str, value: Mapping[str, Any]) -> str:
        raise NotImplementedError

    def ros2_info(self) -> str:
        """Return what tells of the name, while the form cannot be sent."""
        raise NotImplementedError

    @property
    def _type(self) -> str:
        ends = self.ends()
        return ends[0][0] if ends is not None and ends[0] else ""

    def ros2_command(self) -> str:
        type_name, value = self._type, self.form.value
        if type_name and value is not None and self._form_for == self.name_shown:
            return self.ros2_line(type_name, value)
        return self.ros2_info() if self.name_shown else ""

    def load(self) -> None:
        if self._form_for:
            self._texts[self._form_for] = self.form.text
        if self._type and self.name_shown != self._form_for:
            self._form_for = self.name_shown
            self.form.load(self._type, self._texts.get(self.name_shown))

    def redraw(self) -> None:
        if not self.name_shown or not self.is_mounted:
            return
        ends, rows = self.ends(), [heading(_("It has left the graph."))]
        told = [] if self._type else [_("nobody serves it any more")]
        if ends is not None:
            types, servers, clients = ends
            if len(types) > 1:
                told = [_("Nodes use different types for it; Deck uses {type}.").format(type=types[0])]
            rows = [link(GraphPlace(GraphKind.TYPE, name), "type", _("type")) for name in types]
            rows += node_links(servers, "serves", _("serves it"))
            rows += node_links(clients, "calls", _(self.calls_it))
        self.head.show(self.name_shown, *told)
        self.links.show_links(rows)
        columns, asked = self.asked()
        self.asked_rows.display = bool(asked)
        self.asked_rows.show(columns, asked)
        self._show_answer()
        if self.can_cancel != self._could_cancel:
            self._could_cancel = self.can_cancel
            self.screen.refresh_bindings()

    def first(self) -> Widget:
        return self.form.editor

    def on_rows_highlighted(self, event: Rows.Highlighted) -> None:
        if event.rows is self.asked_rows:
            event.stop()
            self._show_answer()
            self.screen.refresh_bindings()

    def on_yaml_form_submitted(self, event: YamlForm.Submitted) -> None:
        event.stop()
        if self.deck.feed.graph is None:
            self.warn(_("no lesson is running"))
        elif self._form_for != self.name_shown or not self._type:
            self.warn(_("nobody serves it any more"))
        else:
            self.ask(self._type, event.value)
        self.redraw()

    def _show_answer(self) -> None:
        title, name, tree = self.answer()
        bar = self.query_one(".ask-title", Static)
        if bar.content != title:
            bar.update(title)
        echo = self.query_one(EchoTree)
        if isinstance(tree, tuple):
            echo.show_words(name, *tree)
        else:
            echo.show_message(name, tree)
