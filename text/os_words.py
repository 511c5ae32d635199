"""What the operating system says of a file, marked for the catalogue: its words are English.

Whoever tells of an OSError makes a sentence of its `strerror`, which is found there by these.
"""

from __future__ import annotations

from text.marks import N_

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
