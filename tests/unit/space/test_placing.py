"""Drawables in the fixed frame, and frames with their names."""

from __future__ import annotations

import math

import numpy as np
import pytest

from space.buffer import NoTransformError, Stamped, TransformBuffer
from space.drawing.camera import Angle, SpaceCamera
from space.drawing.extent import extent_of
from space.drawing.paints import Tint
from space.drawing.shapes import Floor, Shape, Sign, Speckles, Strokes, places
from space.frame_names import FrameNames
from space.placing import Placer, cube_of, robot_root
from space.reading.fields import Drawable
from space.transform import Transform

NOW_S = 10.0


def placed(
    placer: Placer, known: TransformBuffer, drawables: list[Drawable], cube_m: float = 0.1
) -> tuple[list[Shape], str]:
    """The shapes in the map, and why some are missing."""
    found, why = placer.find(known, "map", drawables)
    return placer.place(found, cube_m), why


def with_names(known: TransformBuffer, fixed: str, camera: SpaceCamera) -> list[Shape]:
    """Axes and names of all frames."""
    return FrameNames().shapes(Placer().frames(known, fixed)[0], camera)


def buffer(*edges: tuple[str, str, float], stamp_s: float = NOW_S) -> TransformBuffer:
    """A tree: parent, child, and how far along x the child is."""
    made = TransformBuffer()
    made.add(Stamped(a, b, stamp_s, Transform((x, 0.0, 0.0))) for a, b, x in edges)
    return made


def dot(frame: str, stamp_s: float | None = None) -> Drawable:
    """One point in the origin of a frame."""
    return Drawable(frame, (Speckles(places((0.0, 0.0, 0.0))),), stamp_s)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("metres", [1e9, 1e300])
def test_what_is_no_place_on_earth_is_not_drawn_but_told(metres: float) -> None:
    known = buffer(("map", "base_link", 1.0), ("base_link", "lost", metres))
    shapes, why = placed(Placer(), known, [dot("base_link"), dot("lost")])
    assert len(shapes) == 1
    assert why == "not joined to map: lost is farther than 100000 km from map"
    found, apart = Placer().frames(known, "map")
    assert [one.drawable.frame for one in found] == ["map", "base_link"]
    assert apart == ["lost"]
    assert with_names(known, "map", SpaceCamera())


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
def test_the_fixed_frame_is_the_root_of_the_robots_tree(
    edges: tuple[tuple[str, str, float], ...], root: str
) -> None:
    assert robot_root(buffer(*edges)) == root


def test_without_frames_the_frame_of_what_is_seen_is_the_fixed_one() -> None:
    assert robot_root(TransformBuffer(), ["lidar", "map"]) == "lidar"
    assert robot_root(TransformBuffer()) == ""


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


def test_without_any_frame_what_is_mounted_is_seen_about_the_robot() -> None:
    placer, nothing = (
        Placer({"sonar": ("base_link", Transform((0.3, 0.0, 0.0)))}),
        TransformBuffer(),
    )
    assert placer.root(nothing, ["sonar", "odom"]) == "base_link"
    assert placer.root(nothing, ["odom", "sonar"]) == "odom"
    found, why = placer.find(nothing, "base_link", [dot("sonar")])
    assert [one.at.translation[0] for one in found] == [0.3]
    assert not why


def test_a_cloud_is_thinned_once_for_each_size() -> None:
    rng = np.random.default_rng(1)
    cloud = Drawable("map", (Speckles(rng.uniform(0, 1, (9000, 3)).astype(np.float32)),))
    placer, known = Placer(), buffer(("map", "odom", 0.0))
    (coarse,), _why = placed(placer, known, [cloud], 0.25)
    (fine,), _why = placed(placer, known, [cloud], 0.0625)
    assert isinstance(coarse, Speckles)
    assert isinstance(fine, Speckles)
    assert len(coarse.places) == 64
    assert 64 < len(fine.places) <= 4096


def test_the_cubes_are_about_as_large_as_a_dot() -> None:
    for dots_per_m in (1.0, 7.0, 40.0, 100.0):
        assert 0.5 < cube_of(SpaceCamera(dots_per_m=dots_per_m)) * dots_per_m <= 1.0
    assert cube_of(SpaceCamera(dots_per_m=20_000.0)) == 0.004


def test_each_frame_has_three_axes_and_a_name() -> None:
    known = buffer(("map", "base_link", 3.0))
    shapes = with_names(known, "map", SpaceCamera(Angle.ABOVE, dots_per_m=40.0))
    signs = {shape.text: shape.place for shape in shapes if isinstance(shape, Sign)}
    assert signs == {"map": (0.0, 0.0, 0.0), "base_link": (3.0, 0.0, 0.0)}
    strokes = [shape for shape in shapes if isinstance(shape, Strokes)]
    assert [stroke.paint for stroke in strokes] == [Tint.X_AXIS, Tint.Y_AXIS, Tint.Z_AXIS] * 2
    assert strokes[3].ends[0].tolist() == pytest.approx([3.15, 0.0, 0.0])


def test_frames_in_one_place_share_a_line_the_parents_first() -> None:
    edges = [("map", "odom", 0.0), ("odom", "base", 0.0), ("base", "a", 0.0), ("base", "b", 0.001)]
    shapes = with_names(buffer(*edges), "map", SpaceCamera())
    assert [shape.text for shape in shapes if isinstance(shape, Sign)] == ["map +4"]


def test_axes_are_seen_from_afar() -> None:
    camera = SpaceCamera(dots_per_m=1.0)
    shapes = with_names(buffer(("map", "odom", 0.0)), "map", camera)
    (first, *_rest) = (shape for shape in shapes if isinstance(shape, Strokes))
    assert np.linalg.norm(first.ends - first.starts) == pytest.approx(5.0)


def test_a_loop_of_frames_ends() -> None:
    known = buffer(("a", "b", 1.0), ("b", "a", 1.0))
    found, apart = Placer().frames(known, robot_root(known))
    assert {*apart} | {one.drawable.frame for one in found} == {"a", "b"}


def test_the_extent_holds_all_but_outliers_and_rays_that_met_nothing() -> None:
    points = np.zeros((5000, 3), dtype=np.float32)
    points[:, 0] = np.linspace(0, 10, 5000)
    points[17] = (900.0, 0.0, 0.0)
    cells = np.zeros((10, 10), dtype=np.uint8)
    cells[2, 3] = Tint.FREE
    far = places((99.0, 0.0, 0.0))
    box = extent_of(
        [
            Speckles(points),
            Floor(cells, 1.0, Transform((-5.0, 0.0, 0.0))),
            Strokes(far, far, Tint.MUTED),
        ]
    )
    assert box is not None
    assert box.least == pytest.approx((-2.0, 0.0, 0.0), abs=0.1)
    assert box.most == pytest.approx((10.0, 3.0, 0.0), abs=0.1)
    assert extent_of([]) is None
    assert not box.holds(box.widened(0.1, 0.0))
    assert box.widened(0.0, 100.0).size_m == pytest.approx(100.0)
    assert math.isfinite(box.size_m)


def test_what_stands_looks_the_same_and_what_moves_does_not() -> None:
    placer, drawable = Placer(), dot("odom")
    ((first,), _why), ((near,), _), ((far,), _) = (
        placer.find(buffer(("map", "odom", x)), "map", [drawable]) for x in (1.0, 1.001, 1.1)
    )
    assert first.looks_like(near, 0.002)
    assert not first.looks_like(far, 0.002)
    turned = first._replace(at=Transform.from_rpy((1.0, 0.0, 0.0), (0.0, 0.0, 0.01)))
    assert not first.looks_like(turned, 0.002)
