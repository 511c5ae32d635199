"""Lines of the screen without the caches that they never use: nine megabytes less of them.

Textual gives each line seven caches when it is made, and a screen with many tabs keeps ten thousand
lines. Here a line gets a cache when it is first asked for. A test fails when Textual changes them.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from textual.cache import FIFOCache
from textual.strip import Strip

if TYPE_CHECKING:
    from rich.segment import Segment

SIZES = {
    "_divide_cache": 4,
    "_crop_cache": 16,
    "_style_cache": 16,
    "_filter_cache": 4,
    "_line_length_cache": 4,
    "_crop_extend_cache": 4,
    "_offsets_cache": 4,
}
"""How many entries each has. Source: `textual.strip.Strip.__init__`."""

_init = Strip.__init__


@contextmanager
def lean_strips() -> Iterator[None]:
    """Make caches only where they are used."""
    Strip.__init__ = _lean_init  # type: ignore[assignment,method-assign]
    Strip.__getattr__ = _made  # type: ignore[attr-defined]
    try:
        yield
    finally:
        # Lines that were made meanwhile still lack their caches: what makes these stays.
        Strip.__init__ = _init  # type: ignore[method-assign]


def _lean_init(strip: Strip, segments: Iterable[Segment], cell_length: int | None = None) -> None:
    strip._segments = list(segments)  # noqa: SLF001 - there is no public way
    strip._cell_length = cell_length  # noqa: SLF001
    strip._render_cache = strip._link_ids = strip._cell_count = None  # noqa: SLF001


def _made(strip: Strip, name: str) -> FIFOCache[Any, Any]:
    """Called where an attribute is missing."""
    size = SIZES.get(name)
    if size is None:
        raise AttributeError(name)
    cache: FIFOCache[Any, Any] = FIFOCache(size)
    setattr(strip, name, cache)
    return cache
