"""Tunes how the C library keeps memory: pictures arrive ten times a second and are soon freed."""

from __future__ import annotations

import ctypes
from contextlib import suppress
from functools import lru_cache

M_TRIM_THRESHOLD = -1
M_MMAP_THRESHOLD = -3
M_ARENA_MAX = -8
"""Source: `malloc.h` of glibc, mallopt(3)."""
LARGEST_BYTES = 4_000_000
MOST_ARENAS = 2
KEPT_BYTES = 2 * LARGEST_BYTES
GIVEN_BACK_EVERY_S = 10.0
"""Whatever large messages have left behind by then is small against what the programs need."""


def keep_room_for_large_messages() -> None:
    """Let the C library keep a few megabytes instead of giving them back after each message.

    Otherwise every picture of 640x480 causes some 400 page faults, two thirds of the cost of taking
    it (measured: 1.6 ms against 0.5 ms). Does nothing if the C library is not glibc.
    """
    try:
        mallopt = _c_library().mallopt
    except (AttributeError, OSError):
        return
    # Else most threads have a heap of their own, and each keeps what it once needed.
    mallopt(M_ARENA_MAX, MOST_ARENAS)
    mallopt(M_MMAP_THRESHOLD, LARGEST_BYTES)
    mallopt(M_TRIM_THRESHOLD, KEPT_BYTES)


def give_back_free_memory() -> None:
    """Give back to the system what the C library keeps free between objects that are in use.

    A heap shrinks by itself at its end only, and something small that lives long is always there.
    Takes some milliseconds. Does nothing if the C library is not glibc.
    """
    with suppress(AttributeError, OSError):
        _c_library().malloc_trim(0)


@lru_cache(1)
def _c_library() -> ctypes.CDLL:
    """Return it; each one that is made stays until all garbage is collected."""
    return ctypes.CDLL(None)
