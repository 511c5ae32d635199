"""A type: its users, and its fields as a folding tree."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any, ClassVar

from rich.text import Text
from textual.binding import Binding, BindingType
from textual.message import Message
from textual.widgets import Tree

from graph.messages.browse import Constant, Definition, MessageField, definition
from graph.messages.types import UnknownTypeError
from text import ros2_words
from text.i18n import N_, _, localized
from text.plain import plain
from tui.graph.pane import EmptyNotice, GraphLinks, GraphPane, heading, link
from tui.graph.parameters import typed
from tui.graph.places import GraphKind, GraphPlace
from tui.widgets.name_head import NameHead
from tui.widgets.working import Working

if TYPE_CHECKING:
    from textual.app import ComposeResult
    from textual.widget import Widget
    from textual.widgets.tree import TreeNode

    from graph.messages.browse import Definition
    from tui.widgets.rows import Row

LONGEST = 200
WIDEST = 2**63 - 1
"""A bound of this size or more is not informative."""
PARTS = {
    "request": N_("request"),
    "response": N_("response"),
    "goal": N_("goal"),
    "result": N_("result"),
    "feedback": N_("feedback"),
}


class GraphTypeTree(Tree["str | None"], Working):
    """Fields with their types, defaults and bounds; a field that holds a message can be opened."""

    class TypeWanted(Message):
        """Enter was pressed on a field that holds a message, to go to its type."""

        def __init__(self, type_name: str) -> None:
            super().__init__()
            self.type_name = type_name

    ICON_NODE = "▸ "
    ICON_NODE_EXPANDED = "▾ "
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("right", "unfold", show=False),
        Binding("left", "fold", show=False),
        Binding("up,k", "cursor_up", show=False),
        Binding("down,j", "cursor_down", show=False),
        Binding("enter", "open", show=False),
    ]
    DEFAULT_CSS = """
    GraphTypeTree { height: 1fr; width: 1fr; padding: 0 1; background: transparent; }
    GraphTypeTree:focus { background-tint: $foreground 0%; }
    """

    def __init__(self) -> None:
        super().__init__("")
        self.show_root = False
        self.guide_depth = 2
        self.auto_expand = False

    def show_definition(self, shown: Definition) -> None:
        self.clear()
        self.root.expand()
        for part in shown.parts:
            at = self.root
            if part.name in PARTS:
                label = Text(_(PARTS[part.name]), "bold")
                at = self.root.add(label, expand=True)
            _fill(at, part.fields, part.constants)
        self.cursor_line = 0
        self.refresh()

    def action_unfold(self) -> None:
        """Open the field at the cursor, or enter it."""
        node = self.cursor_node
        if node is not None and node.allow_expand and not node.is_expanded:
            node.expand()
        else:
            self.action_cursor_down()

    def action_fold(self) -> None:
        """Close the field at the cursor, or go to its parent."""
        node = self.cursor_node
        if node is None:
            return
        if node.allow_expand and node.is_expanded:
            node.collapse()
        elif node.parent is not None and node.parent is not self.root:
            self.move_cursor(node.parent)

    def action_open(self) -> None:
        """Request the type of the field at the cursor."""
        node = self.cursor_node
        if node is not None and node.data:
            self.post_message(self.TypeWanted(node.data))
        elif node is not None and node.allow_expand:
            node.toggle()

    def on_tree_node_expanded(self, event: Tree.NodeExpanded[str | None]) -> None:
        """Load the fields of the message in this field."""
        event.stop()
        node = event.node
        if node.data and not node.children:
            self.run_worker(self._load(node, node.data), exit_on_error=False)

    async def _load(self, node: TreeNode[str | None], type_name: str) -> None:
        try:
            # The first use of a package imports it, which takes time.
            found = await asyncio.to_thread(definition, type_name)
        except UnknownTypeError as error:
            node.add_leaf(Text(plain(localized(error.reason), LONGEST), "italic"))
            return
        for part in found.parts:
            _fill(node, part.fields, part.constants)


def _fill(node: TreeNode[str | None], fields: tuple[MessageField, ...], constants: tuple[Constant, ...]) -> None:
    if not fields and not constants:
        node.add_leaf(Text(_("no fields"), "italic dim"))
    width = min(30, max((len(field.name) for field in fields), default=0))
    for field in fields:
        label = Text.assemble((f"{plain(field.name):{width}} ", "bold"), *_told(field))
        if field.message:
            node.add(label, data=field.message)
        else:
            node.add_leaf(label)
    for constant in constants:
        node.add_leaf(
            Text.assemble((f"{plain(constant.name)} ", "italic"), f"= {plain(typed(constant.value), LONGEST)}")
        )


def _told(field: MessageField) -> list[Any]:
    """Return type, default, and the bounds that the name of the type does not include."""
    parts: list[Any] = [(plain(field.type_name), "cyan")]
    if not field.message:
        default = f'"{field.default}"' if isinstance(field.default, str) else typed(field.default)
        parts.append(f" = {plain(default, LONGEST)}")
    if field.least is not None and field.greatest is not None and field.greatest < WIDEST:
        parts.append((f"  {field.least}…{field.greatest}", "dim"))
    return parts


class TypePane(GraphPane):
    """The tree above, its users below."""

    DEFAULT_CSS: ClassVar[str] = """
    TypePane {
        GraphLinks { height: auto; max-height: 25%; min-height: 1; }
    }
    """
    _definition: Definition | None = None
    _failure = ""

    def compose(self) -> ComposeResult:
        yield NameHead()
        yield EmptyNotice()
        yield GraphTypeTree()
        yield GraphLinks()

    @property
    def fields(self) -> GraphTypeTree:
        return self.query_one(GraphTypeTree)

    def ros2_command(self) -> str:
        return ros2_words.interface(self.name_shown) if self.name_shown else ""

    def show_name(self, name: str) -> None:
        if name != self.name_shown:
            self._definition, self._failure = None, ""
        super().show_name(name)

    def redraw(self) -> None:
        if not self.name_shown or not self.is_mounted:
            return
        self.query_one(NameHead).show(self.name_shown)
        rows, links = self._users(), self.query_one(GraphLinks)
        links.show_links(rows)
        links.display = bool(rows)
        words = self.query_one(EmptyNotice)
        words.display = bool(self._failure)
        self.fields.display = not self._failure
        if self._failure:
            words.show(_("this type cannot be inspected"), localized(self._failure))

    def relabel(self) -> None:
        if self._definition is not None:
            self.fields.show_definition(self._definition)
        self.redraw()

    def first(self) -> Widget:
        return self.fields if self.fields.display else super().first()

    def load(self) -> None:
        self.run_worker(self._load(self.name_shown), group="load", exclusive=True)

    async def _load(self, name: str) -> None:
        try:
            # Reading a type imports its package, which takes time.
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
        """Return everything that uses the type, as links."""
        update = self.graph_now
        if update is None:
            return []
        rows = (
            (GraphKind.TOPIC, update.topics),
            (GraphKind.SERVICE, update.services),
            (GraphKind.ACTION, update.actions),
        )
        found = [
            link(GraphPlace(kind, name), "used")
            for kind, of_kind in rows
            for name in sorted(row.name for row in of_kind if self.name_shown in row.type_names)
        ]
        return [heading(_("Used by")), *found] if found else []
