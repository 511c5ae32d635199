"""The head: where it looks, in degrees and drawn, and what it was told."""

from __future__ import annotations

import math

import pytest

from tests.tui.panel_stage import alone, rows
from tui.panels.head.reading import HeadReading, head_in
from tui.panels.head.widget import HeadView


def test_radians_become_degrees_left_and_up() -> None:
    value = {"name": ["tilt_joint", "pan_joint"], "position": [math.pi / 18, math.pi / 4]}
    pose = head_in(value)
    assert pose is not None
    assert (pose.pan_words, pose.tilt_words) == ("45° left", "10° up")
    assert (HeadReading(-45, -10).pan_words, HeadReading(-45, -10).tilt_words) == (
        "45° right",
        "10° down",
    )
    assert HeadReading(0.2, -0.2).pan_words == "0°"


@pytest.mark.parametrize(("width", "height"), [(50, 1), (40, 3), (18, 3), (30, 8), (60, 20)])
async def test_the_angles_are_numbers_at_every_size(width: int, height: int) -> None:
    view = HeadView()
    async with alone(view, width, height).run_test(size=(80, 30)):
        view.show(HeadReading(45, 10))
        shown = "\n".join(rows(view))
        assert "45° left" in shown
        assert "10° up" in shown


async def test_it_moves_while_the_pose_changes_and_rests_when_it_does_not() -> None:
    view = HeadView()
    async with alone(view, 44, 10).run_test(size=(60, 30)):
        view.show(HeadReading(0, 0))
        assert "at rest" in "\n".join(rows(view))
        view.show(HeadReading(10, 0))
        assert "moving" in "\n".join(rows(view))
        view.show(HeadReading(10, 0))
        assert "at rest" in "\n".join(rows(view))


@pytest.mark.parametrize(("width", "height"), [(44, 10), (30, 10), (24, 4)])
async def test_a_head_that_nobody_knows_of_does_not_move(width: int, height: int) -> None:
    """Servos tell nothing: before the first turn, and after their cable was pulled."""
    view = HeadView()
    async with alone(view, width, height).run_test(size=(60, 30)):
        for pose in (HeadReading(math.nan, math.nan), HeadReading(math.nan, math.nan)):
            view.show(pose)
            shown = "\n".join(rows(view))
            assert "unknown until it turns" in shown
            assert "---" in shown
        view.show(HeadReading(10, 0))
        assert "at rest" in "\n".join(rows(view))
        view.show(HeadReading(math.nan, math.nan))
        assert "unknown until it turns" in "\n".join(rows(view))


async def test_what_it_was_told_and_the_answer_are_shown_harmlessly() -> None:
    view = HeadView()
    async with alone(view, 60, 10).run_test(size=(80, 30)):
        view.show(HeadReading(0, 0))
        view.command(HeadReading(-90, 15))
        assert "commanded: 90° right, 15° up" in "\n".join(rows(view))
        view.answer("[red]no[/red]\x1b[31m")
        assert "[red]no[/red]␛[31m" in "\n".join(rows(view))
        view.command(HeadReading(0, 0))
        assert "[red]" not in "\n".join(rows(view))


@pytest.mark.parametrize("pose", [HeadReading(math.nan, math.inf), HeadReading(1e9, -1e9)])
@pytest.mark.parametrize("size", [(1, 1), (22, 6), (60, 20)])
async def test_impossible_angles_and_sizes_do_no_harm(
    pose: HeadReading, size: tuple[int, int]
) -> None:
    view = HeadView()
    async with alone(view, *size).run_test(size=(80, 30)):
        view.show(pose)
        view.command(pose)
        assert len(rows(view)) == size[1]
