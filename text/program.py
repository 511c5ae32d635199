"""How Deck itself is called in a shell, so that what it prints to be typed can be typed."""

from __future__ import annotations

import os
import shlex
import shutil
import sys
from pathlib import Path

NAME = "deck"


def deck_command() -> str:
    """Return `deck` if a shell would find this program, otherwise its path."""
    program = Path(sys.argv[0])
    if program.name != NAME or program.parent == Path():
        return NAME
    path, found = os.path.abspath(program), shutil.which(NAME)  # noqa: PTH100 - links stay
    if found is not None and os.path.realpath(found) == os.path.realpath(path):
        return NAME
    return shlex.quote(path)


def typable(words: str) -> str:
    """Return the words with each command of Deck's in them, `deck ...`, as it can be typed."""
    call = f"`{NAME} "
    return words.replace(call, f"`{deck_command()} ") if call in words else words
