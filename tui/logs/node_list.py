"""The nodes of a log, with how much each has written and whether it is shown."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

from launcher.status import Severity
from text.i18n import _, decimal
from text.plain import plain
from tui.widgets.rows import Cell, Column, Row, Rows

if TYPE_CHECKING:
    from tui.log_view.filter import LogFilter

HEARD, MUTE, ALONE = "●", "○", "★"


class LogNodes(Rows):
    """One row for each node: its mark, name, number of lines, warnings and errors.

    `Opened` means that the chosen node is to be muted or unmuted.
    """

    DEFAULT_CSS = """
    LogNodes { background: $surface; }
    """

    def show_nodes(self, names: Iterable[str], counts: Mapping[str, Sequence[int]], chosen: LogFilter) -> None:
        """Show these nodes; `counts` has the lines of each by rank of the severity."""
        columns = (
            Column("", 1),
            Column(_("node")),
            Column(_("lines"), 6, right=True),
            Column(_("alarms"), 7, right=True),
        )
        self.show(columns, [_row(name, counts.get(name, ()), chosen) for name in names])


def _row(name: str, counts: Sequence[int], chosen: LogFilter) -> Row:
    heard = chosen.shows_node(name)
    mark = (ALONE if chosen.only == name else HEARD) if heard else MUTE
    meaning = "" if heard else "dim"
    errors = sum(counts[Severity.ERROR.rank :])
    warnings = sum(counts[Severity.WARN.rank : Severity.ERROR.rank])
    alarms = " ".join(f"{letter}{short_count(count)}" for letter, count in (("W", warnings), ("E", errors)) if count)
    alarm_meaning = ("bad" if errors else "warn") if alarms and heard else meaning
    return Row(
        name,
        (
            Cell(mark, meaning),
            Cell(plain(name), meaning),
            Cell(short_count(sum(counts)), meaning),
            Cell(alarms, alarm_meaning),
        ),
    )


def short_count(count: int) -> str:
    """A count in at most four characters: 999, 1.2k, 12k, 1.2M."""
    for size, letter in ((1_000_000, "M"), (1_000, "k")):
        if count >= size:
            value = count / size
            return decimal(f"{value:.1f}{letter}") if value < 10 else f"{int(value)}{letter}"
    return str(count)
