"""Which topics the table shows, and in which order."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from graph.housekeeping import is_housekeeping
from tui.topics.table.columns import COLUMNS, TopicColumn

if TYPE_CHECKING:
    from graph.data import TopicRow

_BY_ID = {column.id: column for column in COLUMNS}


@dataclass(frozen=True)
class TopicsOrder:
    """The column to sort by, and what is left out."""

    column_id: str = "name"
    reverse: bool = False
    """Whether the order is the reverse of the column's own."""
    words: str = ""
    """All of them must occur in the topic's name or type."""
    housekeeping: bool = False
    """Whether topics of ROS itself are shown."""

    @property
    def column(self) -> TopicColumn:
        return _BY_ID[self.column_id]

    @property
    def falling(self) -> bool:
        """Whether the highest value comes first."""
        return self.column.falling is not self.reverse

    def by(self, column_id: str) -> TopicsOrder:
        """The order after this column is chosen; choosing it again reverses the order."""
        if column_id == self.column_id:
            return replace(self, reverse=not self.reverse)
        return replace(self, column_id=column_id, reverse=False)

    def next_column(self, column_ids: list[str]) -> TopicsOrder:
        """The order by the next one of the columns that are shown."""
        at = column_ids.index(self.column_id) if self.column_id in column_ids else -1
        return replace(self, column_id=column_ids[(at + 1) % len(column_ids)], reverse=False)

    def arranged(self, rows: Iterable[TopicRow]) -> list[TopicRow]:
        """The rows to show, in order; equal ones are sorted by name."""
        words = self.words.casefold().split()
        shown = [row for row in rows if self._shows(row, words)]
        shown.sort(key=lambda row: row.name)
        shown.sort(key=self.column.sort_key, reverse=self.falling)
        return shown

    def _shows(self, row: TopicRow, words: list[str]) -> bool:
        if not self.housekeeping and is_housekeeping(row.name):
            return False
        text = f"{row.name} {' '.join(row.type_names)}".casefold()
        return all(word in text for word in words)
