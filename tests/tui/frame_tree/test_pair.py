"""Where one frame is in another, as lines that fit and do not jump."""

from __future__ import annotations

import math

import pytest

from space.transform import Transform
from text.i18n import set_language
from tui.frame_tree.pair import FramePair, pair_lines

ROOM = 44
"""Cells of the panel at 120x40."""


def pair(yaw_deg: float, metres: float = 2.5) -> FramePair:
    place = (metres, -metres, 0.0)
    turned = Transform.from_rpy(place, (math.pi, -0.1, math.radians(yaw_deg)))
    return FramePair("camera_link", "odom", turned)


@pytest.mark.parametrize("yaw_deg", [-179.9, -10.0, 0.0, 10.0, 179.9])
@pytest.mark.parametrize("metres", [-99.9, 0.0, 99.9])
def test_each_quantity_is_one_line_of_a_length_that_does_not_change(
    yaw_deg: float, metres: float
) -> None:
    lines = pair_lines(pair(yaw_deg, metres), ROOM)
    assert len(lines) == 4
    assert max(map(len, lines)) <= ROOM
    assert list(map(len, lines)) == list(map(len, pair_lines(pair(0.0), ROOM)))


def test_what_does_not_fit_beside_its_name_stands_below_it_whole() -> None:
    lines = pair_lines(pair(90.0), 40)
    assert (lines[2], lines[4]) == ("quaternion:", "roll, pitch, yaw, °:")
    assert len(lines[3].split()) == 4
    assert lines[5].split() == ["180.0", "-5.7", "90.0"]
    assert max(map(len, lines)) <= 40


def test_numbers_are_written_as_the_language_does() -> None:
    set_language("ru")
    assert "2,500   -2,500    0,000" in "\n".join(pair_lines(pair(0.0), ROOM))
