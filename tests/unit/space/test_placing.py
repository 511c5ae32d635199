"""What is seen, in the fixed frame, and markers."""

from __future__ import annotations

import pytest

from space.buffer import NoTransformError, Stamped, TransformBuffer
from space.drawing.shapes import Shape, Sign, Speckles, Strokes, places
from space.placing import Placer, robot_root
from space.reading.fields import Drawable
from space.reading.markers import MarkerBook
from space.transform import Transform
from tests.unit.space.trees import marker

NOW_S = 10.0


def placed(placer: Placer, known: TransformBuffer, drawables: list[Drawable]) -> tuple[list[Shape], str]:
    """The shapes in the map, and why some are missing."""
    return placer.place(known, "map", drawables)


def buffer(*edges: tuple[str, str, float], stamp_s: float = NOW_S) -> TransformBuffer:
    """A tree: parent, child, and how far along x the child is."""
    made = TransformBuffer()
    made.add(Stamped(a, b, stamp_s, Transform((x, 0.0, 0.0))) for a, b, x in edges)
    return made


def dot(frame: str, stamp_s: float | None = None) -> Drawable:
    return Drawable(frame, (Speckles(places((0.0, 0.0, 0.0))),), stamp_s)


@pytest.mark.parametrize(
    ("edges", "root"),
    [
        ((("odom", "base_link", 0.0), ("map", "odom", 0.0)), "map"),
        ((("odom", "base_link", 0.0),), "odom"),
        ((("base_link", "camera", 0.0),), "base_link"),
        ((("earth", "map", 0.0), ("map", "odom", 0.0)), "earth"),
        ((("world", "a", 0.0), ("world", "b", 0.0), ("x", "y", 0.0)), "world"),
    ],
)
def test_the_fixed_frame_is_the_root_of_the_robots_tree(edges: tuple[tuple[str, str, float], ...], root: str) -> None:
    assert robot_root(buffer(*edges)) == root


def test_what_is_seen_is_placed_in_the_fixed_frame() -> None:
    known = buffer(("map", "odom", 1.0), ("odom", "base_link", 2.0))
    (shape,), why = placed(Placer(), known, [dot("base_link")])
    assert isinstance(shape, Speckles)
    assert shape.places.tolist() == [[3.0, 0.0, 0.0]]
    assert why == ""


def test_it_is_placed_as_it_was_when_it_was_measured() -> None:
    known = buffer(("map", "laser", 1.0), stamp_s=10.0)
    known.add([Stamped("map", "laser", 12.0, Transform((3.0, 0.0, 0.0)))])
    placer = Placer()
    assert placer.where(known, "map", "laser", 11.0).translation[0] == pytest.approx(2.0)
    # What is not known is taken to be as it is now.
    assert placer.where(known, "map", "laser", 99.0).translation[0] == pytest.approx(3.0)
    assert placer.where(known, "map", "laser").translation[0] == pytest.approx(3.0)


def test_what_cannot_be_placed_says_why_and_the_rest_is_placed() -> None:
    known = buffer(("map", "odom", 1.0), ("world", "lidar", 0.0))
    shapes, why = placed(Placer(), known, [dot("lidar"), dot("odom"), dot("nowhere")])
    assert len(shapes) == 1
    assert why == ("not joined to map: lidar and map are in two trees: nothing joins world and map")


def test_a_mount_is_used_until_somebody_publishes_it() -> None:
    placer = Placer({"sonar": ("base_link", Transform((0.3, 0.0, 0.0)))})
    known = buffer(("odom", "base_link", 2.0))
    assert placer.where(known, "odom", "sonar").translation[0] == pytest.approx(2.3)
    known.add([Stamped("base_link", "sonar", NOW_S, Transform((0.5, 0.0, 0.0)))])
    assert placer.where(known, "odom", "sonar").translation[0] == pytest.approx(2.5)
    with pytest.raises(NoTransformError):
        placer.where(TransformBuffer(), "odom", "sonar")


KINDS: dict[int, type] = {
    0: Strokes,
    1: Strokes,
    2: Strokes,
    3: Strokes,
    4: Strokes,
    5: Strokes,
    6: Strokes,
    7: Strokes,
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
