"""A message as a folding tree: what is cut is told, and nothing moves but what changed."""

from __future__ import annotations

import numpy as np
import pytest

from graph.data import Value
from tests.tui.panel_stage import Bare
from tests.tui.snapshots import seen
from tui.echo.lines import MAX_LINES, EchoLine, echo_lines
from tui.echo.tree import EchoTree

STAMP: dict[str, Value] = {"sec": 17, "nanosec": 250_000_000}
JOINTS: dict[str, Value] = {
    "header": {"stamp": STAMP, "frame_id": "base_link"},
    "name": ["rear_left_wheel_joint", "rear_right_wheel_joint"],
    "velocity": np.array([7.5, -11.25]),
}
SCAN: dict[str, Value] = {"angle_min": -1.5, "ranges": np.arange(360, dtype=np.float32)}


def as_is(_path: tuple[str | int, ...], default: bool) -> bool:
    return default


def all_open(_path: tuple[str | int, ...], _default: bool) -> bool:
    return True


def texts(lines: list[EchoLine]) -> list[str]:
    return [f"{'  ' * line.depth}{line.label} {line.text}".rstrip() for line in lines]


def test_nested_messages_are_open_and_arrays_stand_on_one_line() -> None:
    assert texts(echo_lines(JOINTS, all_open))[:5] + texts(echo_lines(JOINTS, as_is))[1:] == [
        "header:",
        "  stamp:",
        "    sec:             17",
        "    nanosec:  250000000",
        '  frame_id: "base_link"',
        'name:     (2 items)  "rear_left_wheel_joint" "rear_right_wheel_joint"',
        "velocity: (2 items)  7.5 -11.25",
    ]


@pytest.mark.parametrize(
    ("value", "shown"),
    [
        (0.20000000298023224, "0.2"),
        (1e-9, "1.000000e-09"),
        (-2.5e12, "-2.500000e+12"),
        (float("inf"), "inf"),
        (True, "true"),
        (np.float32(0.1), "0.1"),
        (0.0, "0.0"),
    ],
)
def test_numbers_are_short_and_true(value: Value, shown: str) -> None:
    assert echo_lines({"data": value}, as_is)[0].text.strip() == shown


def test_a_long_array_tells_its_length_and_opens_item_by_item() -> None:
    closed = echo_lines(SCAN, as_is)[1]
    assert closed.text.startswith("(360 items)  0.0 1.0 2.0")
    assert closed.text.endswith(" …")
    opened = echo_lines(SCAN, all_open)
    assert texts(opened)[2:4] == ["  [0]:      0.0", "  [1]:      1.0"]
    assert texts(opened)[-1].strip() == "… 160 more items"


def test_a_message_of_any_size_makes_a_bounded_tree() -> None:
    points: list[Value] = [{"x": 1.0, "y": 2.0, "z": [{"deep": 1}] * 300} for _ in range(500)]
    assert len(echo_lines({"points": points}, all_open)) == MAX_LINES + 1


async def test_a_fold_outlives_the_next_message_and_a_visit_to_another_topic() -> None:
    tree = EchoTree()
    app = Bare(tree)
    async with app.run_test(size=(60, 12)) as pilot:
        tree.show_message("/joint_states", JOINTS)
        tree.focus()
        assert "header: (2 fields)" in seen(app)
        await pilot.press("right")
        assert "stamp" in seen(app)
        tree.show_message("/joint_states", dict(JOINTS))
        assert "stamp" in seen(app)
        tree.show_message("/scan", SCAN)
        assert "angle_min" in seen(app)
        tree.show_message("/joint_states", JOINTS)
        assert "stamp" in seen(app)


async def test_the_scroll_bar_of_a_long_message_goes_with_it() -> None:
    tree = EchoTree()
    app = Bare(tree)
    async with app.run_test(size=(60, 5)) as pilot:
        tree.show_message("/joint_states", JOINTS)
        tree.show_message("/long", {f"field{number}": number for number in range(50)})
        await pilot.pause()
        bars = [tree.show_vertical_scrollbar]
        tree.show_words("/silent", "no message yet")
        await pilot.pause()
        assert [*bars, tree.show_vertical_scrollbar] == [True, False]
        assert "no message yet" in seen(app)
