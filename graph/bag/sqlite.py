"""An SQLite file of a bag, of any version of rosbag2; a damaged one is read from both its ends.

The file itself is never changed. What SQLite has beside it, a log of changes that are not in the
file yet, is read with it, from a copy of both.
"""

from __future__ import annotations

import shutil
import sqlite3
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, NamedTuple
from urllib.parse import quote

from graph.bag.decoding import TypeText
from graph.bag.errors import BagError
from graph.bag.mcap_records import ROS2_SCHEMAS
from graph.bag.offers import offer_in
from graph.bag.part import CDR, Channel, Found, Lost
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Sequence
    from contextlib import ExitStack

UNCHANGED = "immutable=1"
"""Reads only, and makes no files beside it."""
BESIDE = ("-wal", "-journal")
"""Endings of the files in which SQLite keeps what is not, or no longer, in the file itself."""


class _Row(NamedTuple):
    """A message without its content."""

    stamp_ns: int
    number: int
    topic: int


class SqlitePart:
    """An open SQLite file."""

    said: int | None = None
    """It counts its messages by looking at each."""
    cut_bytes: int | None = None

    def __init__(self, file: Path, unpacked: Path, stack: ExitStack) -> None:
        """Read `unpacked`, which is called `file`; `stack` is closed with it.

        Raises BagError, OSError and sqlite3.Error.
        """
        self.file = file
        self._stack = stack
        self._lost: dict[int, Lost] = {}
        """Number of a message to what is lost there."""
        self._salvaged: list[_Row] | None = None
        """What can be read of a damaged file."""
        self.start_ns = self.end_ns = 0
        self._db = self._opened(unpacked)
        self.distro = self._distro()
        self._definitions = self._defined()
        self.channels: Sequence[Channel] = self._channels(self._counted())

    @property
    def lost(self) -> list[Lost]:
        """What has turned out to be damaged so far."""
        return list(self._lost.values())

    def messages(self, start_ns: int | None, numbers: Collection[int]) -> Iterator[Found]:
        """Yield messages of these channels in the order of their times."""
        wanted = frozenset(numbers)
        for row in self._rows(start_ns or 0):
            if row.topic not in wanted:
                continue
            raw = self._content(row.number)
            if raw is None:
                self._lost[row.number] = Lost(row.stamp_ns, 1)
            else:
                yield row.stamp_ns, row.topic, raw

    def close(self) -> None:
        """Let go of the file."""
        self._stack.close()

    def _rows(self, start_ns: int) -> Iterator[_Row]:
        if self._salvaged is not None:
            return (row for row in self._salvaged if row.stamp_ns >= start_ns)
        asked = "SELECT timestamp, id, topic_id FROM messages WHERE timestamp >= ? "
        return map(_Row._make, self._db.execute(f"{asked} ORDER BY timestamp, id", (start_ns,)))

    def _content(self, number: int) -> bytes | None:
        try:
            asked = "SELECT data FROM messages WHERE id = ?"
            (raw,) = self._db.execute(asked, (number,)).fetchone() or (None,)
        except sqlite3.DatabaseError:
            return None
        return raw if isinstance(raw, bytes) else None

    def _opened(self, file: Path) -> sqlite3.Connection:
        mode = UNCHANGED
        if is_being_written(file):
            file, mode = self._copied(file), "mode=rw"
        # It is opened by one thread and read by another, never by two at once.
        found = sqlite3.connect(address(file, mode), uri=True, check_same_thread=False)
        self._stack.callback(found.close)
        # Otherwise SQLite refuses a file that is shorter than it says of itself as a whole.
        found.execute("PRAGMA writable_schema = ON")
        found.text_factory = lambda raw: raw.decode(errors="replace")
        tables = {name for (name,) in found.execute("SELECT name FROM sqlite_master")}
        if not {"messages", "topics"} <= tables:
            raise BagError(say("{file} is a database, but not of a recording", file=self.file.name))
        return found

    def _copied(self, file: Path) -> Path:
        folder = Path(self._stack.enter_context(TemporaryDirectory(prefix="deck-bag-")))
        for ending in ("", *BESIDE):
            beside = Path(f"{file}{ending}")
            if beside.exists():
                shutil.copyfile(beside, folder / beside.name)
        return folder / file.name

    def _columns(self, table: str) -> set[str]:
        return {row[1] for row in self._db.execute(f"PRAGMA table_info({table})")}

    def _distro(self) -> str:
        if "ros_distro" not in self._columns("schema"):
            return ""
        found = self._db.execute("SELECT ros_distro FROM schema").fetchone()
        return str(found[0]) if found else ""

    def _defined(self) -> dict[str, tuple[str, bool]]:
        """Return for each type its text, and whether it is IDL."""
        if "encoded_message_definition" not in self._columns("message_definitions"):
            return {}
        asked = "SELECT topic_type, encoding, encoded_message_definition FROM message_definitions"
        return {
            name: (text, ROS2_SCHEMAS[encoding])
            for name, encoding, text in self._db.execute(asked)
            if encoding in ROS2_SCHEMAS and text
        }

    def _counted(self) -> dict[int, int]:
        """Return how many messages each topic has; note first and last time."""
        asked = "SELECT topic_id, count(*), min(timestamp), max(timestamp) FROM messages GROUP BY topic_id"
        try:
            rows = self._db.execute(asked).fetchall()
        except sqlite3.DatabaseError:
            return self._salvage()
        self.start_ns = min((row[2] for row in rows), default=0)
        self.end_ns = max((row[3] for row in rows), default=0)
        return {row[0]: row[1] for row in rows}

    def _salvage(self) -> dict[int, int]:
        """Find what can be read of a damaged file, from its beginning and from its end."""
        first, last = self._until_damage("ASC"), self._until_damage("DESC")
        found = {row.number: row for row in (*first, *last)}
        self._salvaged = sorted(found.values())
        # What was behind the last of a file that is cut, nobody knows.
        gap = max(0, last[-1].number - first[-1].number - 1) if first and last else None
        self._lost[-1] = Lost(max((row.stamp_ns for row in first), default=0), gap)
        self.start_ns = self._salvaged[0].stamp_ns if found else 0
        self.end_ns = self._salvaged[-1].stamp_ns if found else 0
        counts: dict[int, int] = {}
        for row in self._salvaged:
            counts[row.topic] = counts.get(row.topic, 0) + 1
        return counts

    def _until_damage(self, order: str) -> list[_Row]:
        found: list[_Row] = []
        try:
            asked = f"SELECT timestamp, id, topic_id FROM messages ORDER BY id {order}"
            for row in self._db.execute(asked):
                # The last page may be there in part.
                if all(isinstance(value, int) for value in row):
                    found.append(_Row._make(row))  # noqa: PERF401 - kept when there is an error
        except sqlite3.DatabaseError:
            pass
        return found

    def _channels(self, counts: dict[int, int]) -> list[Channel]:
        has_offers = "offered_qos_profiles" in self._columns("topics")
        asked = "SELECT id, name, type, serialization_format, {} FROM topics ORDER BY id"
        offers = "offered_qos_profiles" if has_offers else "''"
        rows = self._db.execute(asked.format(offers)).fetchall()
        nameless = sum(counts.values()) - sum(counts.get(row[0], 0) for row in rows)
        if nameless:
            self._lost[-2] = Lost(self.start_ns, nameless)
        return [
            Channel(
                number,
                topic,
                TypeText(kind, *self._definitions.get(kind, ("", False))),
                counts.get(number, 0),
                encoding or CDR,
                *offer_in(profiles),
            )
            for number, topic, kind, encoding, profiles in rows
        ]


def address(file: Path, mode: str = UNCHANGED) -> str:
    """Return where a database is, for `sqlite3.connect` with `uri=True`."""
    return f"file:{quote(str(file.absolute()))}?{mode}"


def is_being_written(file: Path) -> bool:
    """Whether a part of the database stands in a file beside it."""
    return any(_holds_something(Path(f"{file}{ending}")) for ending in BESIDE)


def _holds_something(file: Path) -> bool:
    try:
        return file.stat().st_size > 0
    except OSError:
        return False
