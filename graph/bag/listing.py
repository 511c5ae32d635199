"""The bags in a folder, judged by metadata and first bytes: no message is read or decoded."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from graph.bag.defects import defect_of, endless
from graph.bag.reading import SUFFIXES, metadata_of
from text.os_words import os_reason
from text.sentences import say


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
                bag = _listed_or_refused(path)
                if bag is not None:
                    found.append(bag)
    return sorted(found, key=lambda bag: (-bag.changed_s, bag.name))


def _listed_or_refused(path: Path) -> ListedBag | None:
    """Return a bag, or what forbids to look whether it is one. Raises OSError if it has gone."""
    try:
        return _listed(path)
    except PermissionError as error:
        why = say("it cannot be read: {reason}", reason=os_reason(error))
        return ListedBag(path.name, path, 0, path.stat().st_mtime, trouble=why)


def _listed(path: Path) -> ListedBag | None:
    files = sorted(path.iterdir()) if path.is_dir() else [path]
    parts = [file for file in files if file.suffix in SUFFIXES]
    if not parts:
        return None
    stats = [file.stat() for file in parts]
    size, changed_s = sum(one.st_size for one in stats), max(one.st_mtime for one in stats)
    metadata = metadata_of(path) if path.is_dir() else {}
    broken = defect_of(path, parts, metadata) or endless(parts) or ""
    if not path.is_dir() or broken:
        return ListedBag(path.name, path, size, changed_s, trouble=broken)
    try:
        known = _known(metadata)
    except (KeyError, TypeError, ValueError):
        broken = say("its metadata.yaml is missing or damaged")
        return ListedBag(path.name, path, size, changed_s, trouble=broken)
    return ListedBag(path.name, path, size, changed_s, *known)


def _known(metadata: Mapping[str, Any]) -> tuple[float, int, int]:
    """Return seconds, topics and messages; raises KeyError, TypeError or ValueError."""
    seconds = int(metadata["duration"]["nanoseconds"]) / 1e9
    topics = metadata["topics_with_message_count"]
    return seconds, len(topics), int(metadata["message_count"])
