"""Recognises files that are not bag files after all by their first bytes."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

from text.sentences import Words, say

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

_KINDS = {".mcap": (b"\x89MCAP0\r\n", "MCAP"), ".db3": (b"SQLite format 3\x00", "SQLite")}
"""The first bytes of a file by its suffix, and the name of its format. An MCAP file also ends
with these bytes."""


def defect_of(folder: Path, files: Iterable[Path], metadata: Mapping[str, object]) -> Words | None:
    """Return what is wrong with one of a bag's files, None if all of them begin correctly.

    `metadata`: the content of the bag's metadata.yaml, which names its files.
    """
    named = metadata.get("relative_file_paths")
    for name in (Path(str(each)).name for each in (named if isinstance(named, list) else ())):
        # The first rosbag2 put the folder in front of the name; readers ignore that too.
        if not (folder / name).exists():
            return say("metadata.yaml names {file}, which is not there", file=name)
    for file in files:
        begin, kind = _KINDS[file.suffix]
        with file.open("rb") as opened:
            found = opened.read(len(begin))
        if not found:
            return say("{file} is empty, nothing was written to it", file=file.name)
        if not begin.startswith(found):
            return say("{file} is not an {kind} file", file=file.name, kind=kind)
    return None


def endless(files: Iterable[Path]) -> Words | None:
    """Return which of a bag's files was not closed properly, None if none is known to be."""
    for file in files:
        if file.suffix == ".mcap":
            end, _kind = _KINDS[file.suffix]
            with file.open("rb") as opened:
                opened.seek(-min(len(end), opened.seek(0, os.SEEK_END)), os.SEEK_END)
                if opened.read() != end:
                    return say(
                        "{file} has no end: it is being written, or was cut short", file=file.name
                    )
    return None
