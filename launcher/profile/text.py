"""Reading the file of a profile: only a small regular UTF-8 file is accepted."""

from __future__ import annotations

import os
import stat
from pathlib import Path
from typing import TYPE_CHECKING

from text.os_words import os_reason
from text.sentences import say
from text.yaml_tree import FilePlace

if TYPE_CHECKING:
    from launcher.profile.problems import Problems

SHIPPED = Path(__file__).resolve().parents[2] / "profiles"
"""The profiles of the course."""
MAX_BYTES = 256 * 1024


def shown(path: Path) -> str:
    """Return the path for messages: relative if it is below the current folder."""
    absolute = path.absolute()
    try:
        return str(absolute.relative_to(Path.cwd()))
    except (ValueError, OSError):
        return str(absolute)


def read_text(path: Path, problems: Problems) -> str | None:
    """Return the text of a profile, or None and a problem that says why."""
    place = FilePlace(shown(path))
    try:
        # Opening a pipe or a terminal could block: check the type of file first.
        mode = path.stat().st_mode
        if not stat.S_ISREG(mode):
            kind = say("a directory") if stat.S_ISDIR(mode) else say("not a regular file")
            problems.add(place, (), say("expected a YAML file, found {kind}", kind=kind), _inside(path))
            return None
        with path.open("rb") as file:
            data = file.read(MAX_BYTES + 1)
    except OSError as error:
        problems.add(place, (), *_unreadable(error))
        return None
    if len(data) > MAX_BYTES:
        limit = MAX_BYTES // 1024
        problems.add(place, (), say("is larger than {limit} KiB: too large for a profile", limit=limit))
        return None
    return _decoded(data, place.file, problems)


def _inside(path: Path) -> str:
    """Return a hint that lists the profiles in the directory, if it has any."""
    if not path.is_dir() or not os.access(path, os.R_OK | os.X_OK):
        return ""
    names = sorted(child.name for child in path.glob("*.yaml"))[:5]
    return say("it contains: {names}", names=", ".join(names)) if names else ""


def _unreadable(error: OSError) -> tuple[str, str]:
    if isinstance(error, FileNotFoundError):
        return say("no such file"), say("`deck list` shows all profiles")
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
