"""A type: what uses it, and what it is made of."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, ClassVar

from graph.messages.types import UnknownTypeError
from text.i18n import _, said
from tui.graph.index import users_of
from tui.graph.links import GraphLinks, heading, link
from tui.graph.pane import GraphHead, GraphPane, Words
from tui.graph.place import Place
from tui.graph.type_tree import GraphTypeTree

if TYPE_CHECKING:
    from textual.app import ComposeResult
    from textual.timer import Timer
    from textual.widget import Widget

    from graph.messages.browse import Definition
    from tui.widgets.rows import Row

SETTLED_S = 0.12
"""How long a choice must stand before its package is imported."""


class TypePane(GraphPane):
    """Users above, the tree below."""

    DEFAULT_CSS: ClassVar[str] = """
    TypePane {
        GraphLinks { height: auto; max-height: 25%; min-height: 1; }
    }
    """

    def __init__(self, *, id: str | None = None) -> None:
        super().__init__(id=id)
        self._settling: Timer | None = None
        self._definition: Definition | None = None
        self._failure = ""

    def compose(self) -> ComposeResult:
        """Head, tree, users."""
        yield GraphHead()
        yield Words()
        yield GraphTypeTree()
        yield GraphLinks()

    @property
    def fields(self) -> GraphTypeTree:
        """The fields."""
        return self.query_one(GraphTypeTree)

    @property
    def is_settling(self) -> bool:
        """Whether its package is to be loaded."""
        return self._settling is not None

    def show_name(self, name: str) -> None:
        """Show another type once the choice stands."""
        if name != self.name_shown:
            self._definition, self._failure = None, ""
            if self._settling is not None:
                self._settling.stop()
            self._settling = self.set_timer(SETTLED_S, self._load_soon)
        super().show_name(name)

    def redraw(self) -> None:
        """Show who uses it, and why there is no tree."""
        if not self.name_shown or not self.is_mounted:
            return
        self.query_one(GraphHead).show(self.name_shown)
        rows = self._users()
        links = self.query_one(GraphLinks)
        links.show_links(rows)
        links.display = bool(rows)
        words = self.query_one(Words)
        words.display = bool(self._failure)
        self.fields.display = not self._failure
        if self._failure:
            words.show(_("this type cannot be inspected"), said(self._failure))

    def relabel(self) -> None:
        """Say everything anew."""
        if self._definition is not None:
            self.fields.show_definition(self._definition)
        self.redraw()

    def first(self) -> Widget:
        """The tree."""
        return self.fields if self.fields.display else self.query_one(GraphLinks)

    def _load_soon(self) -> None:
        self._settling = None
        self.run_worker(self._load(self.name_shown), group="load", exclusive=True)

    async def _load(self, name: str) -> None:
        # Reading a type imports its package, which takes its time.
        from graph.messages.browse import definition

        try:
            found = await asyncio.to_thread(definition, name)
        except UnknownTypeError as error:
            if name == self.name_shown:
                self._failure = error.reason
                self.redraw()
            return
        if name == self.name_shown:
            self._definition = found
            self.fields.show_definition(found)

    def _users(self) -> list[Row]:
        rows: list[Row] = []
        for kind, names in users_of(self.graph_now, self.name_shown).items():
            rows += [link(Place(kind, name), "used") for name in sorted(names)]
        return [heading(_("Used by")), *rows] if rows else []
