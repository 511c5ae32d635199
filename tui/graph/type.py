"""A type: its fields down to the last, and its users."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator

from graph.messages.browse import MessageField, definition
from graph.messages.types import UnknownTypeError
from text import ros2_words
from text.i18n import N_, _, localized
from text.plain import plain
from tui.graph.index import GraphKind, GraphPlace
from tui.graph.pane import LONGEST, GraphPane, heading, link
from tui.graph.parameters import typed
from tui.widgets.rows import Cell, Row

WIDEST = 2**63 - 1
"""A bound of this size or more is not informative."""
PARTS = {
    "request": N_("request"),
    "response": N_("response"),
    "goal": N_("goal"),
    "result": N_("result"),
    "feedback": N_("feedback"),
}


class TypePane(GraphPane):
    """Fields with their types, defaults and bounds; Enter on one that holds a message goes to its type."""

    _loaded = ""
    """The type whose package is imported."""
    _failure = ""

    def ros2_command(self) -> str:
        return ros2_words.interface(self.name_shown) if self.name_shown else ""

    def show_name(self, name: str) -> None:
        if name != self.name_shown:
            self._loaded = self._failure = ""
        super().show_name(name)

    def redraw(self) -> None:
        if not self.name_shown or not self.is_mounted:
            return
        self.head.show(self.name_shown)
        words = self.notice
        words.display = bool(self._failure)
        if self._failure:
            words.show(_("this type cannot be inspected"), localized(self._failure))
        fields = field_rows(self.name_shown) if self._loaded == self.name_shown else ()
        self.links.show_links([*fields, *self._users()])

    def load(self) -> None:
        self.run_worker(self._load(self.name_shown), group="load", exclusive=True)

    async def _load(self, name: str) -> None:
        failure = ""
        try:
            # Reading a type imports its package and those of its fields, which takes time.
            await asyncio.to_thread(lambda: list(field_rows(name)))
        except UnknownTypeError as error:
            failure = error.words
        if name == self.name_shown:
            self._failure, self._loaded = failure, "" if failure else name
            self.redraw()

    def _users(self) -> Iterator[Row]:
        update = self.graph_now
        if update is None:
            return
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
        if found:
            yield heading(_("Used by"))
            yield from found


def field_rows(type_name: str, at: str = "") -> Iterator[Row]:
    """Yield the fields and constants of a type, those of a field indented below it.

    `at` is the path of the field that holds it. Raises UnknownTypeError for the type itself only.
    """
    indent = "  " * at.count("/")
    for part in definition(type_name).parts:
        if part.name in PARTS:
            yield heading(_(PARTS[part.name]))
        if not part.fields and not part.constants:
            yield heading(indent + _("no fields"))
        for field in part.fields:
            path = f"{at}/{part.name}.{field.name}"
            cells = Cell(indent + plain(field.name)), Cell(_told(field))
            if not field.message:
                yield Row(path, cells)
                continue
            yield Row(GraphPlace(GraphKind.TYPE, field.message).key(path), cells)
            try:
                yield from field_rows(field.message, path)
            except UnknownTypeError as error:
                yield heading(f"{indent}  {plain(localized(error.words), LONGEST)}")
        for constant in part.constants:
            value = plain(typed(constant.value), LONGEST)
            cells = Cell(indent + plain(constant.name), "dim"), Cell(f"= {value}", "dim")
            yield Row(f"{at}/{part.name}.{constant.name}", cells)


def _told(field: MessageField) -> str:
    told = plain(field.type_name)
    if not field.message:
        default = f'"{field.default}"' if isinstance(field.default, str) else typed(field.default)
        told += f" = {plain(default, LONGEST)}"
    if field.least is not None and field.greatest is not None and field.greatest < WIDEST:
        told += f"  {field.least}…{field.greatest}"
    return told
