"""Names of frames: which of them share a line, whose name it has, and that it does not flicker."""

from __future__ import annotations

from space.drawing.camera import Angle, SpaceCamera
from space.drawing.shapes import Sign
from space.frame_names import FrameNames
from space.placing import Located
from space.reading.fields import Drawable
from space.transform import Transform

CAMERA = SpaceCamera(Angle.ABOVE, dots_per_m=1.0)
"""A metre is a dot."""


def frame(name: str, x: float, y: float = 0.0, z: float = 0.0) -> Located:
    return Located(Drawable(name, ()), Transform((x, y, z)))


def lines(names: FrameNames, *frames: Located, first: tuple[str, ...] = ()) -> list[str]:
    shapes = names.shapes(frames, CAMERA, first)
    return [shape.text for shape in shapes if isinstance(shape, Sign)]


def test_frames_below_each_other_share_a_line_from_above_but_not_from_the_side() -> None:
    frames = (frame("base", 0.0), frame("mast", 0.0, z=50.0))
    assert lines(FrameNames(), *frames) == ["base, mast"]
    side = FrameNames().shapes(frames, SpaceCamera(Angle.SIDE, dots_per_m=1.0))
    assert [one.text for one in side if isinstance(one, Sign)] == ["base", "mast"]


def test_of_many_the_one_that_matters_most_is_named_and_written_first() -> None:
    frames = [frame("odom", 40.0), *(frame(f"joint_{n}", n / 10) for n in range(9))]
    assert lines(FrameNames(), *frames) == ["odom", "joint_0 +8"]
    first = ("", *["nowhere"] * 20, "joint_7", "odom", "joint_7")
    assert lines(FrameNames(), *frames, first=first) == ["joint_7 +8", "odom"]


def test_a_frame_that_trembles_at_the_limit_stays_in_its_line() -> None:
    names = FrameNames()

    def at(x: float) -> list[str]:
        return lines(names, frame("base", 0.0), frame("arm", x))

    assert at(4.5) == ["base", "arm"]
    assert at(3.9) == ["base, arm"]
    assert at(4.5) == at(6.9) == ["base, arm"]
    assert at(7.1) == at(4.5) == ["base", "arm"]


def test_a_frame_does_not_change_between_two_lines_that_are_as_far() -> None:
    names = FrameNames()

    def at(x: float) -> list[str]:
        return lines(names, frame("left", 0.0), frame("right", 6.0), frame("ball", x))

    assert at(2.5) == at(3.5) == ["left, ball", "right"]
    assert at(7.5) == at(2.5) == ["left", "right, ball"]


def test_without_frames_nothing_is_drawn() -> None:
    assert FrameNames().shapes((), CAMERA) == []
