"""Which files make up a bag, and opening them: by what is in them, not by what they are called."""

from __future__ import annotations

import re
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from graph.bag import kinds
from graph.bag.errors import BagError, no_bag, unreadable
from graph.bag.packed import unpack
from graph.bag.stated import METADATA, Stated, stated_in
from text.sentences import say

if TYPE_CHECKING:
    from graph.bag.part import BagPart

_DIGITS = re.compile(r"(\d+)")


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
        return _files(path)
    except OSError as error:
        raise unreadable(path, error) from error


def opened(file: Path) -> BagPart:
    """Open a file of a bag. Raises BagError that says why it cannot be read."""
    stack = ExitStack()
    try:
        return _opened(file, stack)
    except BaseException as error:
        stack.close()
        if isinstance(error, Exception) and not isinstance(error, BagError):
            raise unreadable(file, error) from error
        raise


def _opened(file: Path, stack: ExitStack) -> BagPart:
    from graph.bag.mcap import McapPart
    from graph.bag.sqlite import SqlitePart

    content = file
    if kinds.storage_of(file) == kinds.ZSTD:
        folder = stack.enter_context(TemporaryDirectory(prefix="deck-bag-"))
        content = Path(folder, file.stem)
        unpack(file, content)
    if (defect := kinds.defect_of(content)) is not None:
        raise BagError(defect)
    is_sqlite = kinds.storage_of(content) == kinds.SQLITE
    return (SqlitePart if is_sqlite else McapPart)(file, content, stack)


def _files(path: Path) -> BagFiles:
    path = path.parent if path.name == METADATA else path
    if not path.exists():
        raise no_bag(path, say("there is no such file or folder"))
    if path.is_file():
        _refuse_foreign(path, [path])
        if not kinds.is_bag_file(path) and not kinds.storage_of(path):
            raise no_bag(path, say("the name ends neither in .mcap nor in .db3"))
        return BagFiles(path, None, (path,))
    if not path.is_dir():
        raise no_bag(path, say("it is neither a file nor a folder"))
    stated = stated_in(path)
    found = {file.name: file for file in sorted(path.iterdir(), key=_natural) if file.is_file()}
    named, missing = _named(found, stated.files if stated else ())
    others = [file for file in found.values() if kinds.is_bag_file(file) and file not in named]
    if not named:
        named, others = _unpacked_first(others), []
    if not named and not missing:
        _refuse_foreign(path, [*(found.values())])
        raise no_bag(path, say("it has neither metadata.yaml nor an .mcap file"))
    if not named:
        raise BagError(
            say(
                "{path} cannot be read: metadata.yaml names {file}, which is not there",
                path=path,
                file=", ".join(missing),
            )
        )
    if stated is not None and stated.storage not in {"", kinds.MCAP, kinds.SQLITE}:
        _refuse_unknown(path, stated.storage, named)
    return BagFiles(path, stated, tuple(named), tuple(others), tuple(missing))


def _named(found: dict[str, Path], names: tuple[str, ...]) -> tuple[list[Path], list[str]]:
    """Return the files that metadata name, packed or unpacked since, and the names without one."""
    named, missing = [], []
    for name in dict.fromkeys(names):
        packed = (name + suffix for suffix in sorted(kinds.PACKED_SUFFIXES))
        unpacked = (name.removesuffix(suffix) for suffix in kinds.PACKED_SUFFIXES)
        file = next((found[each] for each in (name, *unpacked, *packed) if each in found), None)
        if file is None:
            missing.append(name)
        elif file not in named:
            named.append(file)
    return named, missing


def _unpacked_first(files: list[Path]) -> list[Path]:
    """Leave out packed files that are there unpacked, too."""
    names = {file.name for file in files}
    return [
        file for file in files if file.suffix not in kinds.PACKED_SUFFIXES or file.with_suffix("").name not in names
    ]


def _natural(file: Path) -> list[tuple[int, str]]:
    """Sort `walk_2` before `walk_10`."""
    return [(int(part), "") if part.isdecimal() else (-1, part) for part in _DIGITS.split(file.name)]


def _refuse_foreign(path: Path, files: list[Path]) -> None:
    """Raise BagError if one of the files is a recording in another form."""
    for file in files:
        other = kinds.foreign(file)
        if other is not None:
            raise BagError(say("{path} cannot be read: {reason}", path=path, reason=other))


def _refuse_unknown(path: Path, storage: str, files: list[Path]) -> None:
    """Raise BagError for a storage that Deck does not read, unless the files are of one it does."""
    if any(kinds.storage_of(file) for file in files):
        return
    raise BagError(
        say(
            "{path}: storage {storage!r} is not known, only mcap and sqlite3; where ROS is "
            "installed with its plugin, `ros2 bag convert` makes one of the other",
            path=path,
            storage=storage,
        )
    )
