"""The bags in a folder, judged by metadata and by what their files count: no message is read or decoded."""

from __future__ import annotations

import sqlite3
from contextlib import closing, suppress
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import quote

from graph.bag import files
from graph.bag.files import Stated, stated_in
from graph.bag.parts import summary_of
from graph.bag.reading import count_words
from text.os_words import os_reason
from text.sentences import Words, say


@dataclass(frozen=True)
class ListedBag:
    """One bag of a folder."""

    name: str
    path: Path
    bytes: int
    """Size of its files on the disk."""
    changed_s: float
    """When it was last written, unix time."""
    seconds: float | None = None
    """From the first message to the last; None if the metadata does not say."""
    topics: int | None = None
    messages: int | None = None
    trouble: str = ""
    """Why less is known, as translatable words; empty for a whole bag."""


def bags_in(folder: Path) -> list[ListedBag]:
    """Return the bags of a folder, newest first; none if there is no such folder."""
    found = []
    with suppress(OSError):
        for path in folder.iterdir():
            with suppress(OSError):
                try:
                    bag = _listed(path)
                except PermissionError as error:
                    # Nobody can tell whether it is one.
                    why = say("it cannot be read: {reason}", reason=os_reason(error))
                    bag = ListedBag(path.name, path, 0, path.stat().st_mtime, trouble=why)
                if bag is not None:
                    found.append(bag)
    return sorted(found, key=lambda bag: (-bag.changed_s, bag.name))


def _listed(path: Path) -> ListedBag | None:
    inside = sorted(path.iterdir()) if path.is_dir() else [path]
    parts = [file for file in inside if files.storage_of_name(file) or file.suffix == files.ROS1_SUFFIX]
    if not parts:
        return None
    stats = [file.stat() for file in parts]
    size, changed_s = sum(one.st_size for one in stats), max(one.st_mtime for one in stats)
    stated = stated_in(path) if path.is_dir() else None
    broken = _missing(stated, {file.name for file in inside}) or _broken(parts) or ""
    if path.is_dir() and not broken and (stated is None or stated.seconds is None or stated.messages is None):
        broken = say("its metadata.yaml is missing or damaged")
    if broken or stated is None or stated.messages is None:
        return ListedBag(path.name, path, size, changed_s, trouble=broken)
    counts = [None if stated.compression else _counted(file) for file in parts]
    held = stated.messages if None in counts else sum(count or 0 for count in counts)
    if held < stated.messages:
        broken = count_words(stated.messages, held)
    messages = min(held, stated.messages)
    return ListedBag(path.name, path, size, changed_s, stated.seconds, len(stated.offers), messages, broken)


def _counted(file: Path) -> int | None:
    """Return how many messages a file holds by its own account; None where only reading it would tell.

    An MCAP file has it in its summary, an SQLite file in the index of its times. Raises OSError.
    """
    kind = files.storage_of(file)
    if kind == files.MCAP:
        from mcap.reader import SeekingReader

        with file.open("rb") as opened:
            summary = summary_of(SeekingReader(opened))
        return summary.statistics.message_count if summary and summary.statistics else None
    if kind != files.SQLITE or files.beside_database(file):
        return None
    try:
        with closing(sqlite3.connect(f"file:{quote(str(file.absolute()))}?immutable=1", uri=True)) as base:
            return int(base.execute("SELECT count(*) FROM messages").fetchone()[0])
    except sqlite3.Error:
        return None


def _missing(stated: Stated | None, names: set[str]) -> Words | None:
    """Return which of the files that the metadata name is not there, None if all are."""
    absent = [name for name in (stated.files if stated else ()) if name not in names]
    if not absent:
        return None
    return say("metadata.yaml names {file}, which is not there", file=", ".join(absent))


def _broken(parts: list[Path]) -> Words | None:
    """Return what is wrong with the first file that is no file of a bag, or has no end."""
    for file in parts:
        if (words := files.defect_of(file)) is not None:
            return words
    for file in parts:
        if files.storage_of(file) == files.MCAP:
            with file.open("rb") as stream:
                if not files.has_end(stream):
                    return say("{file} has no end: it is being written, or was cut short", file=file.name)
    return None
