"""Markers: each kind, and how long they stay."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from space.drawing.paints import nearest
from space.drawing.shapes import Faces, Sign, Speckles, Strokes
from space.reading.fields import NotDrawnError
from space.reading.markers import MarkerBook
from space.transform import Transform
from tests.unit.space.trees import marker

KINDS: dict[int, type] = {
    0: Strokes,
    1: Faces,
    2: Faces,
    3: Faces,
    4: Strokes,
    5: Strokes,
    6: Faces,
    7: Faces,
    8: Speckles,
    9: Sign,
}
POINTS = [{"x": 0.0, "y": 0.0, "z": 0.0}, {"x": 1.0, "y": 0.0, "z": 0.0}]


@pytest.mark.parametrize(("kind", "shape"), KINDS.items())
def test_each_kind_of_marker_is_drawn(kind: int, shape: type) -> None:
    book = MarkerBook()
    at = Transform((1.0, 0.0, 0.0))
    book.read(marker(1, kind, at, (0.5, 0.5, 0.5), points=POINTS, text="here"), 0.0)
    (drawable,) = book.shown(0.0)
    assert isinstance(drawable.shapes[0], shape)
    assert book.remark is None


def test_a_marker_is_placed_by_its_pose_and_its_points() -> None:
    book = MarkerBook()
    book.read(marker(1, 4, Transform((1.0, 0.0, 0.0)), (0.1, 0.1, 0.1), points=POINTS), 0.0)
    (line,) = book.shown(0.0)[0].shapes
    assert isinstance(line, Strokes)
    assert (line.starts[0].tolist(), line.ends[0].tolist()) == ([1, 0, 0], [2, 0, 0])


def test_points_of_a_marker_have_colours_of_their_own() -> None:
    book = MarkerBook()
    colours = [{"r": 1.0, "g": 0.0, "b": 0.0, "a": 1.0}, {"r": 0.0, "g": 0.0, "b": 1.0, "a": 1.0}]
    book.read(marker(1, 8, Transform(), (0.1, 0.1, 0.1), points=POINTS, colors=colours), 0.0)
    (found,) = book.shown(0.0)[0].shapes
    assert isinstance(found, Speckles)
    assert isinstance(found.paint, np.ndarray)
    assert found.paint.tolist() == [nearest(1, 0, 0), nearest(0, 0, 1)]


def test_markers_stay_until_deleted_replaced_or_expired() -> None:
    book = MarkerBook()
    first = marker(1, 1, Transform(), (1.0, 1.0, 1.0))
    book.read({"markers": [first, {**first, "id": 2}, {**first, "id": 3, "ns": "other"}]}, 0.0)
    book.read(first, 0.0)
    assert len(book.shown(0.0)) == 3
    book.read({**first, "action": 2}, 0.0)
    assert len(book.shown(0.0)) == 2
    book.read({**first, "id": 4, "lifetime": {"sec": 1, "nanosec": 500_000_000}}, 10.0)
    assert len(book.shown(11.4)) == 3
    assert len(book.shown(11.6)) == 2
    book.read({**first, "action": 3}, 12.0)
    assert book.shown(12.0) == []


def test_other_kinds_are_named_as_not_drawn() -> None:
    book = MarkerBook()
    mesh = marker(1, 10, Transform(), (1.0, 1.0, 1.0))
    book.read({"markers": [mesh, {**mesh, "id": 2}, {**mesh, "id": 3, "type": 11}]}, 0.0)
    assert book.remark == "not drawn: MESH_RESOURCE (2), TRIANGLE_LIST (1)"
    book.read({"markers": [{**mesh, "action": 2}, {**mesh, "id": 2, "type": 1}]}, 0.0)
    assert book.remark == "not drawn: TRIANGLE_LIST (1)"


def test_a_bad_marker_is_named_and_the_ones_before_it_are_kept() -> None:
    book = MarkerBook()
    good = marker(1, 1, Transform(), (1.0, 1.0, 1.0))
    with pytest.raises(NotDrawnError, match=r"marker things/7: a LINE_LIST needs a multiple of 2"):
        book.read({"markers": [good, {**good, "id": 7, "type": 5, "points": POINTS[:1]}]}, 0.0)
    assert len(book.shown(0.0)) == 1


def test_a_line_with_one_end_that_is_no_place_is_left_out_whole() -> None:
    book = MarkerBook()
    ends = [*POINTS, {"x": math.nan, "y": 0.0, "z": 0.0}, *POINTS, POINTS[1]]
    book.read(marker(1, 5, Transform(), (0.1, 0.1, 0.1), points=ends), 0.0)
    (found,) = book.shown(0.0)[0].shapes
    assert isinstance(found, Strokes)
    assert found.ends[:, 0].tolist() == [1.0, 1.0]
    assert found.starts[:, 0].tolist() == [0.0, 1.0]


@pytest.mark.parametrize(
    ("more", "words"),
    [
        ({"scale": {"x": 0.1, "y": -0.1, "z": 0.1}}, "its scale has to be positive numbers"),
        ({"type": 8, "points": [{"x": 1.0}]}, "points is not a list of x, y, z"),
        ({"type": 8, "points": POINTS, "colors": [{}, {}]}, "colors is not a list of r, g, b, a"),
        ({"color": {"r": math.nan}}, "color.r is not a finite number"),
        ({"lifetime": {"sec": 1}}, "the message has no field lifetime.nanosec"),
    ],
)
def test_what_is_wrong_with_a_marker_is_a_sentence_with_its_name(
    more: dict[str, Any], words: str
) -> None:
    bad = {**marker(7, 1, Transform(), (1.0, 1.0, 1.0)), **more}
    with pytest.raises(NotDrawnError, match=f"marker things/7: {words}"):
        MarkerBook().read(bad, 0.0)
