"""The user's own models: a folder or a file that a parameter names."""

from __future__ import annotations

from pathlib import Path

from brain.speech.faults import SpeechError
from text.sentences import say


def folder_of(model: str, what: str) -> Path:
    """Return the folder of a model.

    Raises:
        SpeechError: none is named, or there is none.
    """
    if not model:
        raise SpeechError(say("{what} needs a model of the language", what=what), say("set model:=FOLDER"))
    path = Path(model).expanduser()
    if not path.is_dir():
        raise SpeechError(say("{path}: there is no such folder", path=str(path)), say("set model:=FOLDER"))
    return path


def one_file(folder: Path, *patterns: str) -> str | None:
    """Return the first file that fits, the smaller (int8) variants first; None without one."""
    for pattern in patterns:
        found = sorted(folder.glob(pattern), key=lambda path: ("int8" not in path.name, path.name))
        if found:
            return str(found[0])
    return None
