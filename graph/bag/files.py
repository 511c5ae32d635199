"""Which files make up a bag, what each of them is by its first bytes, and what metadata.yaml says of them."""

from __future__ import annotations

import os
import re
import shlex
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path, PureWindowsPath
from typing import Any, BinaryIO, NamedTuple

from graph.bag.errors import BagError, unreadable
from text.nested_yaml import read_yaml
from text.os_words import os_reason
from text.sentences import Words, say

MCAP = "mcap"
SQLITE = "sqlite3"
ZSTD = "zstd"
MCAP_MAGIC = b"\x89MCAP0\r\n"
"""An MCAP file also ends with these bytes."""
ZSTD_MAGIC = b"\x28\xb5\x2f\xfd"
_MAGICS = {MCAP_MAGIC: MCAP, b"SQLite format 3\x00": SQLITE, ZSTD_MAGIC: ZSTD}
SUFFIXES = {".mcap": MCAP, ".db3": SQLITE}
PACKED_SUFFIXES = (".zst", ".zstd")
"""Of a file that rosbag2 has compressed as a whole: `walk_0.mcap.zstd`."""
ROS1_SUFFIX = ".bag"
BESIDE = ("-wal", "-journal")
"""Endings of the files in which SQLite keeps what is not, or no longer, in the file itself."""
METADATA = "metadata.yaml"
RELIABILITIES = ("system_default", "reliable", "best_effort", "unknown", "best_available")
"""By their number in rmw's `rmw_qos_reliability_policy_e`."""
DURABILITIES = ("system_default", "transient_local", "volatile", "unknown", "best_available")
"""By their number in rmw's `rmw_qos_durability_policy_e`."""
_USED = {"reliable", "best_effort", "transient_local", "volatile"}
_NAMES = {MCAP: "MCAP", SQLITE: "SQLite"}
_ROS1 = b"#ROSBAG V"
_LFS = b"version https://git-lfs"
_ARCHIVES = {b"PK\x03\x04": "zip", b"\x1f\x8b": "gzip", b"\xfd7zXZ\x00": "xz", b"BZh": "bzip2"}
_PAGES = (b"<!doctype", b"<html")
_HEAD_BYTES = 64
_DIGITS = re.compile(r"(\d+)")


class Offer(NamedTuple):
    """The QoS that the first publisher of a topic offered; empty where that is not known."""

    reliability: str = ""
    durability: str = ""


@dataclass(frozen=True)
class Stated:
    """What a bag's `metadata.yaml` says, of any version of rosbag2, as far as it can be understood."""

    files: tuple[str, ...] = ()
    """Names of its files: the first rosbag2 put the folder in front, readers ignore that."""
    messages: int | None = None
    offers: Mapping[str, Offer] = field(default_factory=dict)
    """Of each topic that is named."""
    seconds: float | None = None
    compression: str = ""
    """Of files or messages: `zstd`; empty for none."""
    distro: str = ""
    trouble: Words | None = None
    """Why nothing is known though there is a file."""


@dataclass(frozen=True)
class BagFiles:
    """The files of a bag, before any is opened."""

    path: Path
    """The folder, or the only file."""
    stated: Stated | None
    """What the folder's metadata.yaml says, None without one."""
    named: tuple[Path, ...]
    """What is read: the files that the metadata name, or all of a folder without them."""
    others: tuple[Path, ...] = ()
    """Files beside them that the metadata do not name."""
    missing: tuple[str, ...] = ()
    """Names in the metadata of files that are not there."""


def files_of(path: Path) -> BagFiles:
    """Return the files that hold messages, without opening any.

    Raises BagError if there are none, or none that can be read.
    """
    try:
        return _files(path.parent if path.name == METADATA else path)
    except OSError as error:
        raise unreadable(path, error) from error


def _files(path: Path) -> BagFiles:
    if not path.exists():
        raise _no_bag(path, say("there is no such file or folder"))
    if path.is_file():
        _refuse_foreign(path, [path])
        if not storage_of_name(path) and not storage_of(path):
            raise _no_bag(path, say("the name ends neither in .mcap nor in .db3"))
        return BagFiles(path, None, (path,))
    if not path.is_dir():
        raise _no_bag(path, say("it is neither a file nor a folder"))
    stated = stated_in(path)
    found = {file.name: file for file in sorted(path.iterdir(), key=_natural) if file.is_file()}
    named, missing = _named(found, stated.files if stated else ())
    others = [file for file in found.values() if storage_of_name(file) and file not in named]
    if not named:
        # A packed file may be there unpacked, too.
        named, others = [file for file in others if file.with_suffix("") not in others], []
    if not named and missing:
        words = say("metadata.yaml names {file}, which is not there", file=", ".join(missing))
        raise BagError(say("{path} cannot be read: {reason}", path=path, reason=words))
    if not named:
        _refuse_foreign(path, [*found.values()])
        raise _no_bag(path, say("it has neither metadata.yaml nor an .mcap file"))
    if stated is not None and stated.compression.lower() not in {"", ZSTD}:
        words = say("it is packed by {kind}, and only zstd is known", kind=stated.compression)
        raise BagError(say("{path} cannot be read: {reason}", path=path, reason=words))
    return BagFiles(path, stated, tuple(named), tuple(others), tuple(missing))


def _named(found: dict[str, Path], names: tuple[str, ...]) -> tuple[list[Path], list[str]]:
    """Return the files that metadata name, packed or unpacked since, and the names without one."""
    named, missing = [], []
    for name in dict.fromkeys(names):
        unpacked = (name.removesuffix(suffix) for suffix in PACKED_SUFFIXES)
        packed = (name + suffix for suffix in PACKED_SUFFIXES)
        file = next((found[each] for each in (name, *unpacked, *packed) if each in found), None)
        if file is None:
            missing.append(name)
        elif file not in named:
            named.append(file)
    return named, missing


def _natural(file: Path) -> list[tuple[int, str]]:
    """Sort `walk_2` before `walk_10`."""
    return [(int(part), "") if part.isdecimal() else (-1, part) for part in _DIGITS.split(file.name)]


def _no_bag(path: Path, reason: Words) -> BagError:
    words = say(
        "{path} is not a bag: {reason}. Give the folder that holds metadata.yaml, or an .mcap file",
        path=path,
        reason=reason,
    )
    return BagError(words)


def _refuse_foreign(path: Path, files: list[Path]) -> None:
    """Raise BagError if one of the files is a recording in another form."""
    for file in files:
        if (other := foreign(file)) is not None:
            raise BagError(say("{path} cannot be read: {reason}", path=path, reason=other))


# What a file is.


def storage_of_name(file: Path) -> str:
    """Return the storage that a file's name promises, packed or not; empty for other names."""
    return SUFFIXES.get((file.with_suffix("") if file.suffix in PACKED_SUFFIXES else file).suffix, "")


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
    if (other := foreign(file)) is not None:
        return other
    if (named := _NAMES.get(storage_of_name(file))) is None:
        return say("{file} is neither an MCAP nor an SQLite file", file=file.name)
    return say("{file} is not an {kind} file", file=file.name, kind=named)


def has_end(stream: BinaryIO) -> bool:
    """Return whether an MCAP file was closed properly."""
    stream.seek(-min(len(MCAP_MAGIC), stream.seek(0, os.SEEK_END)), os.SEEK_END)
    return stream.read() == MCAP_MAGIC


def beside_database(file: Path) -> str:
    """Return the name of a file in which a part of the database stands, empty if all of it is in its own."""
    names = (Path(f"{file}{ending}") for ending in BESIDE)
    return next((beside.name for beside in names if beside.exists() and beside.stat().st_size), "")


def _head(file: Path) -> bytes:
    with file.open("rb") as opened:
        return opened.read(_HEAD_BYTES)


# What the metadata say.


def stated_in(folder: Path) -> Stated | None:
    """Return what the folder's metadata say, None if there are none."""
    import yaml

    try:
        # Not `exists`: what cannot be looked at is not missing.
        found = read_yaml((folder / METADATA).read_text(encoding="utf-8"))
        inner = found["rosbag2_bagfile_information"]
    except (FileNotFoundError, NotADirectoryError):
        return None
    except OSError as error:
        return Stated(trouble=say("metadata.yaml cannot be read: {reason}", reason=os_reason(error)))
    except (yaml.YAMLError, KeyError, TypeError, ValueError):
        inner = None
    if not isinstance(inner, Mapping):
        return Stated(trouble=say("metadata.yaml is damaged: only the files themselves count"))
    nanoseconds = _whole(_within(inner, "duration").get("nanoseconds"))
    topics = [_within(each, "topic_metadata") for each in _listed(inner.get("topics_with_message_count"))]
    packed = _text(inner.get("compression_mode")).lower() not in {"", "none"}
    return Stated(
        files=tuple(PureWindowsPath(str(name)).name for name in _listed(inner.get("relative_file_paths"))),
        messages=_whole(inner.get("message_count")),
        offers={_text(each["name"]): offer_in(each.get("offered_qos_profiles")) for each in topics if "name" in each},
        seconds=None if nanoseconds is None else nanoseconds / 1e9,
        compression=_text(inner.get("compression_format")) if packed else "",
        distro=_text(inner.get("ros_distro")),
    )


def offer_in(profiles: object) -> Offer:
    """Return the first of some recorded QoS profiles; an empty one if they cannot be understood.

    Up to version 8 of the metadata they are YAML in a text, with the numbers of rmw's enumerations; from version 9 on
    a list, with names. MCAP and SQLite files hold the text of either.
    """
    import yaml

    if isinstance(profiles, str):
        try:
            profiles = read_yaml(profiles)
        except (yaml.YAMLError, ValueError):
            return Offer()
    first = profiles[0] if isinstance(profiles, list) and profiles else None
    if not isinstance(first, dict):
        return Offer()
    return Offer(_policy(first.get("reliability"), RELIABILITIES), _policy(first.get("durability"), DURABILITIES))


def _policy(value: object, names: Sequence[str]) -> str:
    """Return the name of a policy that a publisher can offer, else nothing."""
    if isinstance(value, int) and 0 <= value < len(names):
        value = names[value]
    name = str(value).lower()
    return name if name in _USED else ""


def _within(value: object, name: str) -> Mapping[str, Any]:
    """Return the mapping of this name in another one, empty if there is none."""
    found = value.get(name) if isinstance(value, Mapping) else None
    return found if isinstance(found, Mapping) else {}


def _listed(value: object) -> list[object]:
    return value if isinstance(value, list) else []


def _text(value: object) -> str:
    return "" if value is None else str(value)


def _whole(value: object) -> int | None:
    return value if isinstance(value, int) and not isinstance(value, bool) else None
