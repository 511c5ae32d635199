"""A text dump of a screen: its rows as plain text, then where each style stands.

For states of which text and style matter, and no drawing: a diff of it can be read. The app runs
as it does for an SVG snapshot, at the same size. The second part has a paragraph for each style,
and in it the rows and columns, counted from 1, that have it::

    bold #efefef on #1e1e1e
      3-5: 1-20 40-60

Of cells that are blank only the background counts, because nothing else of them is seen.
"""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from itertools import groupby
from typing import Any

import pytest
from rich.segment import Segment
from rich.style import Style
from syrupy.assertion import SnapshotAssertion
from syrupy.extensions.single_file import SingleFileSnapshotExtension, WriteMode
from textual._compositor import LayoutUpdate
from textual._doc import take_svg_screenshot
from textual.app import App

Columns = tuple[int, int]


class TextDumpExtension(SingleFileSnapshotExtension):
    """One `.txt` file for each look."""

    _file_extension = "txt"
    _write_mode = WriteMode.TEXT


def compare_dump(snapshot: SnapshotAssertion, app: App[Any], **how: Any) -> bool:
    """Fail with a unified diff unless the screen is as dumped; `how` is that of `snap_compare`."""
    # What runs the app for an SVG returns whatever the app exports.
    app.export_screenshot = lambda **_options: dump(app)  # type: ignore[method-assign]
    actual = take_svg_screenshot(app, **how)
    if snapshot != actual:
        known = snapshot.executions[snapshot.num_executions - 1].recalled_data
        pytest.fail(_difference(str(known or ""), actual), pytrace=False)
    return True


def _difference(expected: str, actual: str) -> str:
    lines = difflib.unified_diff(
        expected.splitlines(), actual.splitlines(), "expected", "on the screen", lineterm=""
    )
    return "\n".join(("the screen differs from its dump", *lines))


def dump(app: App[Any]) -> str:
    """Return what is on the screen now, with the screens that are seen through it."""
    update = app.screen._compositor.render_update(
        full=True, screen_stack=app._background_screens, simplify=True
    )
    assert isinstance(update, LayoutUpdate)
    rows = [[segment for strip in strips for segment in strip] for strips in update.strips]
    texts = ["".join(segment.text for segment in row).rstrip() for row in rows]
    return "\n".join((*texts, "", "-- styles --", *_styles(rows), ""))


def _styles(rows: Iterable[Iterable[Segment]]) -> Iterable[str]:
    """Return a paragraph for each style; rows that have it in the same columns share a line."""
    found: dict[str, dict[int, list[Columns]]] = {}
    for number, row in enumerate(rows, 1):
        column = 1
        for style, run in groupby(row, _seen):
            width = sum(segment.cell_length for segment in run)
            places = found.setdefault(style, {}).setdefault(number, [])
            places.append((column, column + width - 1))
            column += width
    for style in sorted(found):
        yield style
        yield from _places(found[style])


def _seen(segment: Segment) -> str:
    """Return what of a run's style is seen."""
    style = segment.style or Style.null()
    is_blank = not segment.text.strip() and not (style.underline or style.strike or style.reverse)
    return str(style.background_style if is_blank else style)


def _places(rows: dict[int, list[Columns]]) -> Iterable[str]:
    first = last = 0
    columns: list[Columns] = []
    for row in (*sorted(rows), 0):
        if row and row == last + 1 and rows[row] == columns:
            last = row
            continue
        if columns:
            yield f"  {_range(first, last)}: {' '.join(_range(*place) for place in columns)}"
        first, last, columns = row, row, rows.get(row, [])


def _range(first: int, last: int) -> str:
    return str(first) if first == last else f"{first}-{last}"
