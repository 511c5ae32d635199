"""Reading the file of a profile: a small regular file of UTF-8, whatever the path leads to."""

from __future__ import annotations

import os
import stat
from pathlib import Path
from typing import TYPE_CHECKING

from launcher.profile.tree import FilePlace
from text.os_words import os_reason
from text.sentences import say

if TYPE_CHECKING:
    from launcher.profile.tree import Problems

SHIPPED = Path(__file__).resolve().parents[2] / "profiles"
"""The profiles of the course."""
MAX_BYTES = 256 * 1024


def shown(path: Path) -> str:
    """Return the path as messages name it: relative where that is shorter and goes down."""
    absolute = path.absolute()
    try:
        return str(absolute.relative_to(Path.cwd()))
    except (ValueError, OSError):
        return str(absolute)


def read_text(path: Path, problems: Problems) -> str | None:
    """Return the text of a profile, or None and a problem that says why not."""
    place = FilePlace(shown(path))
    try:
        # A pipe or a terminal would keep us waiting: ask what it is before it is opened.
        mode = path.stat().st_mode
        if not stat.S_ISREG(mode):
            kind = say("a directory") if stat.S_ISDIR(mode) else say("not a regular file")
            problems.add(
                place, (), say("expected a YAML file, found {kind}", kind=kind), _inside(path)
            )
            return None
        with path.open("rb") as file:
            data = file.read(MAX_BYTES + 1)
    except OSError as error:
        problems.add(place, (), *_unreadable(error))
        return None
    if len(data) > MAX_BYTES:
        limit = MAX_BYTES // 1024
        problems.add(
            place, (), say("is larger than {limit} KiB: too large for a profile", limit=limit)
        )
        return None
    return _decoded(data, place.file, problems)


def _inside(path: Path) -> str:
    """Hint at the profiles inside, if the path is a directory of some."""
    if not path.is_dir() or not os.access(path, os.R_OK | os.X_OK):
        return ""
    names = sorted(child.name for child in path.glob("*.yaml"))[:5]
    return say("in it there are: {names}", names=", ".join(names)) if names else ""


def _unreadable(error: OSError) -> tuple[str, str]:
    if isinstance(error, FileNotFoundError):
        return say("no such file"), say("`deck list` shows the profiles there are")
    if isinstance(error, PermissionError):
        return say("no permission to read it"), say("chmod u+r it, or ask its owner")
    return say("cannot be read: {reason}", reason=os_reason(error)), ""


def _decoded(data: bytes, file: str, problems: Problems) -> str | None:
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        before = data[: error.start]
        line = before.count(b"\n") + 1
        column = len(before[before.rfind(b"\n") + 1 :].decode("utf-8", "replace")) + 1
        problems.add(
            FilePlace(file, line, column),
            (),
            say("is not UTF-8: byte 0x{byte:02x}", byte=data[error.start]),
            say("save the file as UTF-8"),
        )
        return None
