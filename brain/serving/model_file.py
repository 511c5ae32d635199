"""A model file, examined before llama.cpp gets it: whether it is one, and what it says of itself.

GGUF: https://github.com/ggml-org/ggml/blob/master/docs/gguf.md. Only the first fields are read;
whatever else is wrong with a file, llama.cpp finds and says.
"""

from __future__ import annotations

import re
import struct
from dataclasses import dataclass
from typing import TYPE_CHECKING

from text.os_words import os_reason
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path
    from typing import BinaryIO

    from text.sentences import Words


class ServingError(Exception):
    """Why a model file is not served; str() is the reason in English."""

    def __init__(self, words: Words) -> None:
        """`words` are made by `text.sentences.say`, and name the fix."""
        super().__init__(words)
        self.words = words


MAGIC = b"GGUF"
_NUMBERS = {
    0: "B", 1: "b", 2: "H", 3: "h", 4: "I", 5: "i", 6: "f", 7: "?", 10: "Q", 11: "q", 12: "d",
}  # fmt: skip
"""Types of values, as `struct` calls them."""
_STRING, _ARRAY = 8, 9
_LONGEST_TEXT = 1 << 20
_LONGEST_ARRAY = 1000
"""Tags and authors are shorter. What is longer are the tokens, and nothing asked for here follows
them."""


@dataclass(frozen=True)
class ModelFile:
    """What the header of a GGUF file says of the model in it."""

    path: Path
    size: int
    """In bytes."""
    trained_context: int | None
    """How many tokens at once the model was trained for, None if the file does not say."""

    @property
    def name(self) -> str:
        """Return what a server calls it: the file's name, without what needs quoting."""
        return re.sub(r"[^A-Za-z0-9._-]+", "-", self.path.stem)[:100].strip("-") or "model"


def examine(path: Path) -> ModelFile:
    """Return what the file says of itself.

    Raises:
        ServingError: if it is not a GGUF file, or cannot be read.
    """
    try:
        if path.is_dir():
            raise ServingError(say("{path} is a folder: name the file in it", path=str(path)))
        size = path.stat().st_size
        if not path.is_file():
            raise ServingError(say("{path} is not a file", path=str(path)))
        with path.open("rb") as file:
            magic = file.read(len(MAGIC))
            context = _trained_context(file) if magic == MAGIC else None
    except FileNotFoundError:
        raise ServingError(say("there is no file {path}", path=str(path))) from None
    except (OSError, ValueError) as error:
        words = say("{path} cannot be read: {reason}", path=str(path), reason=os_reason(error))
        raise ServingError(words) from None
    if not size:
        raise ServingError(say("{path} is empty: download it again", path=str(path)))
    if magic != MAGIC:
        words = say(
            "{path} is not a model for llama.cpp: such files are in the format GGUF, and usually end in .gguf",
            path=str(path),
        )
        raise ServingError(words)
    return ModelFile(path.absolute(), size, context)


def _trained_context(file: BinaryIO) -> int | None:
    """Return `ARCHITECTURE.context_length`, None if it is not among the first fields."""
    architecture = None
    try:
        for key, value in _fields(file):
            if key == "general.architecture":
                architecture = value
            elif key == f"{architecture}.context_length" and isinstance(value, int):
                return value
    except (struct.error, EOFError):
        pass
    return None


def _fields(file: BinaryIO) -> Iterator[tuple[str, object]]:
    """Give the fields of the header in order, until one is too long."""
    _version, _tensors, fields = _unpacked(file, "IQQ")
    for _number in range(fields):
        key = _text(file)
        yield key, _value(file, *_unpacked(file, "I"))


def _value(file: BinaryIO, kind: int) -> object:
    if kind == _STRING:
        return _text(file)
    if kind != _ARRAY:
        return _unpacked(file, _NUMBERS.get(kind, "Q"))[0]
    of, length = _unpacked(file, "IQ")
    if length > _LONGEST_ARRAY or of == _ARRAY:
        raise EOFError
    return [_value(file, of) for _number in range(length)]


def _text(file: BinaryIO) -> str:
    (length,) = _unpacked(file, "Q")
    if length > _LONGEST_TEXT:
        raise EOFError
    return file.read(length).decode("utf-8", "replace")


def _unpacked(file: BinaryIO, kinds: str) -> tuple[int, ...]:
    kinds = f"<{kinds}"
    return struct.unpack(kinds, file.read(struct.calcsize(kinds)))
