"""Lines of the screen without what they never use: nine megabytes of caches, ten of styles.

Textual gives each line seven caches when it is made, and a screen with many tabs keeps ten thousand
lines. Here a line gets a cache when it is first asked for, and none has the line itself in it: such
a line would stay until all garbage is collected, which takes many minutes to come. Textual also
keeps sixteen thousand styles for the sequences that they are drawn by, and nearly each piece of
text has a style of its own, which says where it stands. Here the sequences are kept by what they
draw. A test fails when Textual changes any of it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from rich.style import Style
from textual.cache import FIFOCache
from textual.strip import Strip

if TYPE_CHECKING:
    from rich.color import Color, ColorSystem
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

MOST_SEQUENCES = 4096

_init = Strip.__init__
_render_ansi: Any = Strip.__dict__["render_ansi"]
_rendered: Callable[[type[Strip], Style, ColorSystem], str] = _render_ansi.__func__.__wrapped__
"""The same without keeping the style."""


@contextmanager
def lean_strips() -> Iterator[None]:
    """Make caches only where they are used."""
    Strip.__init__ = _lean_init  # type: ignore[assignment,method-assign]
    Strip.__getattr__ = _made  # type: ignore[attr-defined]
    Strip.render_ansi = classmethod(_lean_ansi)  # type: ignore[assignment]
    try:
        yield
    finally:
        # Lines that were made meanwhile still lack their caches: what makes these stays.
        Strip.__init__ = _init  # type: ignore[method-assign]
        Strip.render_ansi = _render_ansi  # type: ignore[method-assign]


def _lean_init(strip: Strip, segments: Iterable[Segment], cell_length: int | None = None) -> None:
    strip._segments = list(segments)  # noqa: SLF001 - there is no public way
    strip._cell_length = cell_length  # noqa: SLF001
    strip._render_cache = strip._link_ids = strip._cell_count = None  # noqa: SLF001


def _made(strip: Strip, name: str) -> FIFOCache[Any, Any]:
    size = SIZES.get(name)
    if size is None:
        raise AttributeError(name)
    cache = _Cache(size, id(strip))
    setattr(strip, name, cache)
    return cache


class _Cache(FIFOCache[Any, Any]):
    """The cache of a line, for other lines than itself; it is found again in no time anyway."""

    __slots__ = ("_owner",)

    def __init__(self, maxsize: int, owner: int) -> None:
        super().__init__(maxsize)
        self._owner = owner

    def __setitem__(self, key: Any, value: Strip | list[Strip]) -> None:  # noqa: ANN401
        first = value if isinstance(value, Strip) else value[0] if value else None
        if id(first) != self._owner:
            self.set(key, value)


def _lean_ansi(_strip: type[Strip], style: Style, color_system: ColorSystem) -> str:
    attributes = style._attributes & style._set_attributes  # noqa: SLF001 - as Textual does
    style._ansi = _sequence(attributes, style.color, style.bgcolor, color_system)  # noqa: SLF001
    return style._ansi  # noqa: SLF001


@lru_cache(MOST_SEQUENCES)
def _sequence(attributes: int, color: Color | None, ground: Color | None, color_system: ColorSystem) -> str:
    """Return the parameters of the sequence that sets them."""
    style = Style.from_color(color, ground)
    style._attributes = style._set_attributes = attributes  # noqa: SLF001
    return _rendered(Strip, style, color_system)
