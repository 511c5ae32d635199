"""What can go wrong with a bag, in sentences that name the file and the fix."""

from __future__ import annotations

from typing import TYPE_CHECKING

from text.os_words import os_reason
from text.sentences import Words, say

if TYPE_CHECKING:
    from pathlib import Path


class BagError(Exception):
    """A bag cannot be written or read; `words` says which, why, and what to do."""

    def __init__(self, words: Words) -> None:
        """Say `words`."""
        super().__init__(words)
        self.words = words


def not_made(folder: Path, error: OSError) -> BagError:
    """Return that the folder of a recording cannot be made."""
    if isinstance(error, FileExistsError):
        return BagError(
            say("{path} is there already: choose another folder, or remove it", path=folder)
        )
    reason = os_reason(error)
    return BagError(say("{path} cannot be made: {reason}", path=folder, reason=reason))


def not_written(file: Path, error: OSError) -> Words:
    """Return why a recording has ended before its time."""
    reason = os_reason(error)
    return say(
        "recording has ended: {path} cannot be written ({reason}); what was recorded till then "
        "can be replayed. Free some space and record again",
        path=file,
        reason=reason,
    )


def no_bag(path: Path, reason: Words) -> BagError:
    """Return that there is no bag at this place."""
    return BagError(
        say(
            "{path} is not a bag: {reason}. Give the folder that holds metadata.yaml, or an "
            ".mcap file",
            path=path,
            reason=reason,
        )
    )


def unreadable(path: Path, error: Exception) -> BagError:
    """Return that a bag is there and cannot be read."""
    if isinstance(error, BagError):
        return error
    return BagError(
        say(
            "{path} cannot be read: {reason}. Is it whole? `ros2 bag reindex` repairs many bags",
            path=path,
            reason=say(os_reason(error).rstrip(".")),
        )
    )
