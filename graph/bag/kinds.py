"""Tells what a file is by its first bytes, whatever it is called."""

from __future__ import annotations

import os
import shlex
from typing import TYPE_CHECKING

from text.sentences import Words, say

if TYPE_CHECKING:
    from pathlib import Path

MCAP = "mcap"
SQLITE = "sqlite3"
ZSTD = "zstd"
MCAP_MAGIC = b"\x89MCAP0\r\n"
"""An MCAP file also ends with these bytes."""
ZSTD_MAGIC = b"\x28\xb5\x2f\xfd"
_MAGICS = {MCAP_MAGIC: MCAP, b"SQLite format 3\x00": SQLITE, ZSTD_MAGIC: ZSTD}
SUFFIXES = {".mcap": MCAP, ".db3": SQLITE}
PACKED_SUFFIXES = frozenset({".zstd", ".zst"})
"""Of a file that rosbag2 has compressed as a whole: `walk_0.mcap.zstd`."""
ROS1_SUFFIX = ".bag"
_NAMES = {MCAP: "MCAP", SQLITE: "SQLite"}
_ROS1 = b"#ROSBAG V"
_LFS = b"version https://git-lfs"
_ARCHIVES = {b"PK\x03\x04": "zip", b"\x1f\x8b": "gzip", b"\xfd7zXZ\x00": "xz", b"BZh": "bzip2"}
_PAGES = (b"<!doctype", b"<html")
_HEAD = 64


def is_bag_file(file: Path) -> bool:
    """Return whether a file's name is that of a bag's file."""
    return storage_of_name(file) != ""


def storage_of_name(file: Path) -> str:
    """Return the storage that a file's name promises, packed or not; empty for other names."""
    if file.suffix in PACKED_SUFFIXES:
        file = file.with_suffix("")
    return SUFFIXES.get(file.suffix, "")


def storage_of(file: Path) -> str:
    """Return `mcap`, `sqlite3` or `zstd`, empty for anything else. Raises OSError."""
    head = _head(file)
    return next((kind for magic, kind in _MAGICS.items() if head.startswith(magic)), "")


def foreign(file: Path) -> Words | None:
    """Return what a file is instead of a bag's file, None if that cannot be told by its beginning.

    Raises OSError.
    """
    head = _head(file)
    if head.startswith(_ROS1):
        return say(
            "{file} is a recording of ROS 1; convert it: `pip install rosbags`, then "
            "`rosbags-convert --src {source} --dst {target}`",
            file=file.name,
            source=shlex.quote(file.name),
            target=shlex.quote(file.stem),
        )
    if head.startswith(_LFS):
        return say(
            "{file} is a Git LFS pointer, the recording itself is not here; fetch it: `git lfs pull`", file=file.name
        )
    if head.lstrip().lower().startswith(_PAGES):
        return say("{file} is a web page and no recording: download it again", file=file.name)
    for magic, kind in _ARCHIVES.items():
        if head.startswith(magic):
            return say("{file} is packed by {kind}; unpack it first", file=file.name, kind=kind)
    return None


def defect_of(file: Path) -> Words | None:
    """Return why a file is no file of a bag, None if it begins correctly. Raises OSError."""
    head = _head(file)
    if not head:
        return say("{file} is empty, nothing was written to it", file=file.name)
    if any(head.startswith(magic) or magic.startswith(head) for magic in _MAGICS):
        return None
    named = _NAMES.get(storage_of_name(file))
    if (other := foreign(file)) is not None:
        return other
    if named is None:
        return say("{file} is neither an MCAP nor an SQLite file", file=file.name)
    return say("{file} is not an {kind} file", file=file.name, kind=named)


def endless(file: Path) -> Words | None:
    """Return that an MCAP file was not closed properly, None if that is not known."""
    if storage_of(file) != MCAP:
        return None
    with file.open("rb") as opened:
        opened.seek(-min(len(MCAP_MAGIC), opened.seek(0, os.SEEK_END)), os.SEEK_END)
        if opened.read() == MCAP_MAGIC:
            return None
    return say("{file} has no end: it is being written, or was cut short", file=file.name)


def _head(file: Path) -> bytes:
    with file.open("rb") as opened:
        return opened.read(_HEAD)
