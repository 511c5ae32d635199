"""A node and its neighbours as a drawing: inputs on the left, outputs on the right."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

from rich.cells import cell_len

from text.i18n import _
from text.plain import plain
from tui.graph.links import short
from tui.graph.list import ended
from tui.graph.places import GraphKind, GraphPlace

if TYPE_CHECKING:
    from collections.abc import Sequence

    from tui.graph.neighbours import Connection, Neighbours

LEFT, CENTRE, RIGHT = 0, 1, 2
ROOMY = 52
"""Cells of a side from which on nodes have a column of their own."""
LONGEST = 200
UP, DOWN, WEST, EAST = 1, 2, 4, 8
BENDS = " │││─┘┐┤─└┌├─┴┬┼"
"""The line character that connects to these sides, indexed by the sum of their numbers."""
SIGNS = {GraphKind.TOPIC: "", GraphKind.SERVICE: "()", GraphKind.ACTION: " ⚑"}
"""Written after a name: a service is called like a function, an action is given a goal."""


class MapPiece(NamedTuple):
    """A text at a position in the drawing."""

    row: int
    x: int
    text: str
    look: str = ""
    """`name` of a connection, `node`, `box`, `line`, `dim`."""


class MapStop(NamedTuple):
    """Something that the cursor can be on."""

    place: GraphPlace
    row: int
    piece: int
    """Its index among the pieces."""


@dataclass
class MapDrawing:
    """The pieces, and the stops of the cursor by column, from top to bottom."""

    height: int
    pieces: list[MapPiece] = field(default_factory=list)
    stops: tuple[list[MapStop], list[MapStop], list[MapStop]] = field(default_factory=lambda: ([], [], []))

    def put(self, piece: MapPiece, place: GraphPlace | None = None, column: int = CENTRE) -> None:
        """Add a piece; with a `place`, the cursor can be on it."""
        if place is not None:
            self.stops[column].append(MapStop(place, piece.row, len(self.pieces)))
        self.pieces.append(piece)


def drawing(name: str, around: Neighbours, width: int, height: int, top: int = 0) -> MapDrawing:
    """Draw into `width` cells, with the node in the middle of `height` rows below `top`."""
    box = min(cell_len(plain(name, LONGEST)) + 4, max(12, width // 3))
    side = max(6, (width - box - 7) // 2)
    coming = _heights(around.coming, side, height)
    going = _heights(around.going, side, height)
    whole = max(height, sum(coming), sum(going))
    middle = min(whole - 2, top + height // 2)
    drawn = MapDrawing(whole)
    _side(drawn, around.coming, coming, side, middle, LEFT)
    _box(drawn, name, side + 3, box, middle)
    _side(drawn, around.going, going, side, middle, RIGHT, side + 3 + box)
    return drawn


def _heights(connections: Sequence[Connection], side: int, height: int) -> list[int]:
    """Return the number of rows for each connection; one more each if there is room for all."""
    above = 0 if side >= ROOMY else 1
    heights = [above + max(1, len(connection.nodes)) for connection in connections]
    roomy = sum(heights) + len(heights) <= height
    return [rows + 1 for rows in heights] if roomy else heights


def _box(drawn: MapDrawing, name: str, x: int, width: int, middle: int) -> None:
    inner = ended(plain(name, LONGEST), width - 4)
    bar = "─" * (width - 2)
    drawn.put(MapPiece(middle - 1, x, f"┌{bar}┐", "box"))
    drawn.put(MapPiece(middle, x, "│", "box"))
    drawn.put(MapPiece(middle, x + 1, f" {inner:{width - 4}} ", "node"), GraphPlace(GraphKind.NODE, name))
    drawn.put(MapPiece(middle, x + width - 1, "│", "box"))
    drawn.put(MapPiece(middle + 1, x, f"└{bar}┘", "box"))


def _side(
    drawn: MapDrawing,
    connections: Sequence[Connection],
    heights: Sequence[int],
    side: int,
    middle: int,
    column: int,
    x: int = 0,
) -> None:
    """Draw the connections of one side; on the right side, `x` is where the box ends."""
    if not connections:
        words = _("no subscriptions") if column == LEFT else _("no publications")
        at = max(0, side - cell_len(words)) if column == LEFT else x + 3
        drawn.put(MapPiece(middle, at, ended(words, side), "dim"))
        return
    row = max(0, min(middle - sum(heights) // 2, drawn.height - sum(heights)))
    rows = []
    for connection, height in zip(connections, heights, strict=True):
        rows.append(row)
        place = _wide if side >= ROOMY else _narrow
        place(drawn, connection, row, side, column, 0 if column == LEFT else x + 4)
        row += height
    _trunk(drawn, rows, middle, side if column == LEFT else x + 1, column)


def _trunk(drawn: MapDrawing, rows: Sequence[int], middle: int, x: int, column: int) -> None:
    """Draw the line that joins the connections of a side, and leads to the box or away from it."""
    towards, away = (WEST, EAST) if column == LEFT else (EAST, WEST)
    first, last = min(*rows, middle), max(*rows, middle)
    for row in range(first, last + 1):
        bend = (UP if row > first else 0) | (DOWN if row < last else 0)
        bend |= (towards if row in rows else 0) | (away if row == middle else 0)
        drawn.put(MapPiece(row, x, BENDS[bend], "line"))
    if column == LEFT:
        drawn.put(MapPiece(middle, x + 1, "─▶", "line"))
    else:
        drawn.put(MapPiece(middle, x - 1, "─", "line"))
        for row in rows:
            drawn.put(MapPiece(row, x + 1, "▶", "line"))


def _narrow(drawn: MapDrawing, connection: Connection, row: int, side: int, column: int, x: int) -> None:
    """Draw the connection, and below it the nodes at its other end."""
    name = ended(_named(connection), side - 2)
    drawn.put(MapPiece(row, x, name, "name"), connection.place, column)
    if column == LEFT:
        line = " " + "─" * (side - cell_len(name) - 1)
        drawn.put(MapPiece(row, cell_len(name), line, "line"))
    for below, node in enumerate(connection.nodes):
        text = ended(short(node), side - 3)
        drawn.put(MapPiece(row + 1 + below, x + 2, text, "node"), GraphPlace(GraphKind.NODE, node), column)
    if not connection.nodes:
        drawn.put(MapPiece(row + 1, x + 2, _("nobody"), "dim"))


def _wide(drawn: MapDrawing, connection: Connection, row: int, side: int, column: int, x: int) -> None:
    """Draw the connection beside the nodes at its other end, each node in a row of its own."""
    name = ended(_named(connection), side // 2 - 4)
    room = side // 2 - 2
    at = x + side - side // 2 if column == LEFT else x
    if column == LEFT:
        _nodes(drawn, connection, row, x, room, column)
    drawn.put(MapPiece(row, at, name, "name"), connection.place, column)
    rest = side // 2 - cell_len(name)
    if column == LEFT:
        drawn.put(MapPiece(row, at + cell_len(name), " " + "─" * (rest - 1), "line"))
    else:
        if connection.nodes:
            drawn.put(MapPiece(row, at + cell_len(name), " " + "─" * (rest - 1), "line"))
        _nodes(drawn, connection, row, x + side // 2, room, column)


def _nodes(drawn: MapDrawing, connection: Connection, row: int, x: int, room: int, column: int) -> None:
    if not connection.nodes:
        drawn.put(MapPiece(row, x, _("nobody"), "dim"))
    last = len(connection.nodes) - 1
    for number, node in enumerate(connection.nodes):
        at, place = row + number, GraphPlace(GraphKind.NODE, node)
        bend = (UP if number else 0) | (DOWN if number < last else 0)
        name = ended(short(node), room - 3)
        if column == LEFT:
            bend |= WEST | (0 if number else EAST)
            drawn.put(MapPiece(at, x, name, "node"), place, column)
            line = " " + "─" * (room - cell_len(name) - 2) + BENDS[bend]
            drawn.put(MapPiece(at, x + cell_len(name), line, "line"))
            if not number:
                drawn.put(MapPiece(at, x + room, "▶ ", "line"))
        else:
            bend |= EAST | (0 if number else WEST)
            drawn.put(MapPiece(at, x, f"{BENDS[bend]}▶ ", "line"))
            drawn.put(MapPiece(at, x + 3, name, "node"), place, column)


def _named(connection: Connection) -> str:
    return plain(connection.place.name, LONGEST) + SIGNS.get(connection.place.kind, "")
