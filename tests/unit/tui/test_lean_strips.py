"""Lines without their unused caches are the same lines."""

from __future__ import annotations

import gc
from itertools import product
from typing import Any
from weakref import ref

import pytest
from rich.color import ColorSystem
from rich.segment import Segment
from rich.style import Style
from textual.cache import FIFOCache
from textual.strip import Strip

from tui.lean_strips import SIZES, lean_strips

STYLES = (
    Style(),
    Style(bold=True, italic=False, dim=True),
    Style(color="#1264af", bgcolor="color(17)"),
    Style(color="red", reverse=True, underline=True),
    Style(bgcolor="#ffffff", meta={"offset": (3, 7)}),
)


class Watched(Style):
    """One that a weak reference can be made to."""


def caches(strip: Strip) -> dict[str, int]:
    """Return the caches that a line has, with their sizes."""
    held = {name: slot(strip, name) for name in Strip.__slots__}
    return {name: one._maxsize for name, one in held.items() if isinstance(one, FIFOCache)}


def slot(strip: Strip, name: str) -> Any:
    """Return what is in a slot, None if nothing is."""
    try:
        return Strip.__dict__[name].__get__(strip)
    except AttributeError:
        return None


def line() -> Strip:
    return Strip([Segment("Путь "), Segment("свободен", Style(bold=True))])


def test_the_caches_are_those_of_textual() -> None:
    assert caches(line()) == SIZES


def test_a_line_has_a_cache_once_it_uses_it() -> None:
    whole = line()
    with lean_strips():
        lean = line()
        assert caches(lean) == {}
        assert not any(isinstance(each, FIFOCache) for each in gc.get_referents(lean))
        assert lean == whole
        assert lean.crop(2, 9) == whole.crop(2, 9)
        assert lean.crop(2, 9) is lean.crop(2, 9)
        assert set(caches(lean)) == {"_crop_cache"}
        assert lean.divide([3, 13]) == whole.divide([3, 13])
        assert lean.adjust_cell_length(20) == whole.adjust_cell_length(20)
        assert lean.crop_extend(0, 15, None) == whole.crop_extend(0, 15, None)
        assert lean.apply_offsets(1, 2).text == whole.text
        assert lean.cell_length == whole.cell_length == 13
    assert caches(line()) == SIZES
    assert lean.apply_style(Style(dim=True)).text == whole.text
    with pytest.raises(AttributeError, match="_else"):
        _ = lean._else  # type: ignore[attr-defined]


def test_a_line_that_is_shown_whole_goes_as_soon_as_nobody_has_it() -> None:
    """One that its own caches have is garbage of the kind that is collected after minutes."""
    gc.disable()
    try:
        with lean_strips():
            style = Watched(bold=True)
            whole = Strip([Segment("Путь свободен", style)])
            assert [each is whole for each in whole.divide([13])] == [True]
            assert whole.adjust_cell_length(13) is whole
            assert whole.crop_extend(0, 13, None) is whole
            gone = ref(style)
            del whole, style
            assert gone() is None
    finally:
        gc.enable()


@pytest.mark.parametrize(("style", "colours"), product(STYLES, ColorSystem))
def test_each_style_is_drawn_as_before(style: Style, colours: ColorSystem) -> None:
    drawn = Strip.render_ansi(style, colours)
    with lean_strips():
        assert Strip.render_ansi(style, colours) == drawn
        assert Strip.render_style(style, "Путь", colours) == Strip.render_style(
            Style() + style, "Путь", colours
        )
    assert Strip.render_ansi(style, colours) == drawn


def test_where_a_piece_of_text_stands_is_not_kept_for_how_it_is_drawn() -> None:
    with lean_strips():
        style = Watched(bold=True, meta={"offset": (3, 7)})
        Strip.render_ansi(style, ColorSystem.TRUECOLOR)
        kept = ref(style)
        del style
        gc.collect()
        assert kept() is None
