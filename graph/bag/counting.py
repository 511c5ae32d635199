"""How many messages a bag's file holds by its own account, without reading or decoding any."""

from __future__ import annotations

import sqlite3
from contextlib import closing
from typing import TYPE_CHECKING

from graph.bag.kinds import MCAP, SQLITE, storage_of
from graph.bag.mcap_index import counted_in_summary
from graph.bag.sqlite import address, is_being_written

if TYPE_CHECKING:
    from pathlib import Path


def messages_of(file: Path) -> int | None:
    """Return the number of messages; None where only reading the file would tell. Raises OSError.

    An MCAP file has it in its summary, an SQLite file in the index of its times.
    """
    kind = storage_of(file)
    if kind == MCAP:
        with file.open("rb") as opened:
            return counted_in_summary(opened, file.stat().st_size)
    return _in_database(file) if kind == SQLITE and not is_being_written(file) else None


def _in_database(file: Path) -> int | None:
    try:
        with closing(sqlite3.connect(address(file), uri=True)) as base:
            (found,) = base.execute("SELECT count(*) FROM messages").fetchone()
    except sqlite3.Error:
        return None
    return int(found)
