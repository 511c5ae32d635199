"""The bags in a folder, judged by metadata and first bytes: no message is read or decoded."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from graph.bag import kinds
from graph.bag.counting import messages_of
from graph.bag.differences import count_words
from graph.bag.stated import Stated, stated_in
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
    parts = [file for file in files if kinds.is_bag_file(file) or file.suffix == kinds.ROS1_SUFFIX]
    if not parts:
        return None
    stats = [file.stat() for file in parts]
    size, changed_s = sum(one.st_size for one in stats), max(one.st_mtime for one in stats)
    stated = stated_in(path) if path.is_dir() else None
    names = {file.name for file in files}
    broken = _missing(stated, names) or _broken(parts) or ""
    if not path.is_dir() or broken:
        return ListedBag(path.name, path, size, changed_s, trouble=broken)
    if stated is None or stated.seconds is None or stated.messages is None:
        broken = say("its metadata.yaml is missing or damaged")
        return ListedBag(path.name, path, size, changed_s, trouble=broken)
    held = _held(parts, stated)
    fewer = held is not None and held < stated.messages
    messages = held if held is not None and fewer else stated.messages
    figures = stated.seconds, len(stated.topics), messages
    broken = count_words(stated.messages, messages) if fewer else ""
    return ListedBag(path.name, path, size, changed_s, *figures, trouble=broken)


def _held(parts: list[Path], stated: Stated) -> int | None:
    """Return how many messages the files hold by their own account, None where one has none."""
    if stated.compression:
        return None
    counts = [messages_of(file) for file in parts]
    return None if None in counts else sum(count or 0 for count in counts)


def _missing(stated: Stated | None, names: set[str]) -> Words | None:
    """Return which of the files that the metadata name is not there, None if all are."""
    absent = [name for name in (stated.files if stated else ()) if name not in names]
    if not absent:
        return None
    return say("metadata.yaml names {file}, which is not there", file=", ".join(absent))


def _broken(parts: list[Path]) -> Words | None:
    """Return what is wrong with the first file that is no file of a bag, or has no end."""
    for judged in (kinds.defect_of, kinds.endless):
        for file in parts:
            if (words := judged(file)) is not None:
                return words
    return None
