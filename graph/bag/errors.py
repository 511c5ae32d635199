"""Errors of bags, in sentences that name the file and the fix."""

from __future__ import annotations

from typing import TYPE_CHECKING

from text.os_words import os_reason
from text.sentences import SaidError, Words, say

if TYPE_CHECKING:
    from pathlib import Path


class BagError(SaidError):
    """A bag cannot be written or read; `words` says which one, why, and what to do."""


def not_made(folder: Path, error: OSError) -> BagError:
    """Return the error for a recording folder that cannot be created."""
    if isinstance(error, FileExistsError):
        return BagError(say("{path} already exists: choose another folder, or remove it", path=folder))
    reason = os_reason(error)
    return BagError(say("{path} cannot be created: {reason}", path=folder, reason=reason))


def not_written(file: Path, error: OSError) -> Words:
    """Return why a recording has stopped early."""
    reason = os_reason(error)
    return say(
        "recording has stopped: {path} cannot be written ({reason}); what was recorded before "
        "can be replayed. Free some space and record again",
        path=file,
        reason=reason,
    )


def nothing_to_publish(path: Path, messages: int) -> BagError:
    """Return the error for a bag of which no topic can be published, each for its own reason."""
    if not messages:
        return BagError(say("{path}: there are no messages in it", path=path))
    return BagError(say("{path}: none of its topics can be published", path=path))


def unreadable(path: Path, error: Exception) -> BagError:
    """Return the error for a bag that exists but cannot be read."""
    if isinstance(error, BagError):
        reason = error.words
        if str(path) in reason:
            return error
    elif isinstance(error, OSError):
        reason = os_reason(error)
    else:
        reason = say("it is damaged: {reason}", reason=say(os_reason(error).rstrip(".")))
    return BagError(say("{path} cannot be read: {reason}", path=path, reason=reason))
