"""File errors of the operating system, marked for the catalogue: its messages are in English.

Use `os_reason` to report an OSError.
"""

from __future__ import annotations

from text.i18n import N_
from text.plain import plain
from text.sentences import Words, say

REASONS = (
    N_("Permission denied"),
    N_("Operation not permitted"),
    N_("No such file or directory"),
    N_("File exists"),
    N_("Not a directory"),
    N_("Is a directory"),
    N_("Directory not empty"),
    N_("File name too long"),
    N_("Too many levels of symbolic links"),
    N_("Too many open files"),
    N_("No space left on device"),
    N_("Disk quota exceeded"),
    N_("File too large"),
    N_("Read-only file system"),
    N_("Input/output error"),
    N_("Invalid argument"),
)


def os_reason(error: Exception) -> Words:
    """Return the system's reason for a failure; for an error without a message, its type."""
    words = getattr(error, "strerror", None) or str(error) or type(error).__name__
    return say(plain(str(words)))
