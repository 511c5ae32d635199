"""Who is on a topic: every policy of every endpoint, what does not fit, and who disagrees."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import pytest
from rich.cells import cell_len

from graph.data import EndpointInfo, TopicRow
from tests.tui.recorded import TOPICS, lesson_update
from tests.tui.snapshots import Look, settle
from tui.topics.endpoint_lines import endpoint_lines
from tui.topics.screen import TopicsScreen
from tui.topics.words import ends
from tui.widgets.figures import seconds_text

if TYPE_CHECKING:
    from collections.abc import Sequence

FLOAT, DOUBLE = "std_msgs/msg/Float32", "std_msgs/msg/Float64"
LIDAR = EndpointInfo(
    "/lidar", FLOAT, "best_effort", "volatile", 5, "keep_last", 0.1, 0.5, 2.0, "manual_by_topic"
)
BRAIN = EndpointInfo("/brain", FLOAT, "reliable", "volatile", liveliness="automatic")


def a_row(
    published_by: Sequence[EndpointInfo] = (), subscribed_by: Sequence[EndpointInfo] = ()
) -> TopicRow:
    return TopicRow(
        "/scan",
        (FLOAT,),
        len(published_by),
        len(subscribed_by),
        published_by=tuple(published_by),
        subscribed_by=tuple(subscribed_by),
    )


def text(row: TopicRow, width: int = 120) -> str:
    lines = ["".join(ink.text for ink in line) for line in endpoint_lines(row, width)]
    assert all(cell_len(line) <= width for line in lines)
    return "\n".join(" ".join(line.split()) for line in lines)


def test_every_policy_is_shown() -> None:
    shown = text(a_row([LIDAR], [replace(BRAIN, reliability="best_effort")]))
    assert "✓ every subscriber hears every publisher" in shown
    assert ("/lidar best_effort volatile keep_last 5 100 ms 500 ms manual_by_topic 2.0 s") in shown
    assert "/brain best_effort volatile – none none automatic" in shown
    assert "“–” is unknown" in shown


def test_a_pair_that_does_not_fit_is_marked_and_told_with_the_way_out() -> None:
    shown = text(a_row([LIDAR], [BRAIN]))
    words = "✗ /brain does not hear /lidar: reliability reliable is asked for, best_effort is"
    assert words in shown.replace("\n", " ")
    assert "\n✗ /lidar best_effort" in shown
    assert "\n✗ /brain reliable" in shown
    assert "✓" not in shown


def test_who_disagrees_about_the_type_is_named_and_no_qos_is_held_against_it() -> None:
    shown = text(a_row([LIDAR], [replace(BRAIN, type_name=DOUBLE)]))
    assert "✗ The endpoints use different types" in shown
    assert f"{FLOAT}: published by lidar" in shown
    assert f"{DOUBLE}: expected by brain" in shown
    assert "does not hear" not in shown


def test_deck_is_not_nobody() -> None:
    ours = replace(a_row([], [BRAIN]), own_publishers=1)
    assert "Publishers (0)" in text(ours)
    assert "Deck itself publishes here" in text(ours)
    assert "nobody publishes" not in text(ours)
    assert ends(ours) == "Deck → brain"
    assert ends(replace(ours, published_by=(LIDAR,))) == "lidar, Deck → brain"


def test_who_listens_twice_is_told_as_often_as_the_table_counts() -> None:
    row = a_row([LIDAR, BRAIN, BRAIN], [LIDAR, BRAIN, LIDAR, LIDAR])
    assert (row.publishers, row.subscribers) == (3, 4)
    assert ends(row) == "lidar, brain ×2 → lidar ×3, brain"


@pytest.mark.parametrize(
    ("seconds", "shown"),
    [
        (None, "–"),
        (0.0, "0 µs"),
        (12e-6, "12 µs"),
        (0.00012, "0.1 ms"),
        (0.0123, "12.3 ms"),
        (0.35, "350 ms"),
        (0.9999, "1.0 s"),
        (-0.002, "-2.0 ms"),
        (250.0, "250 s"),
    ],
)
def test_times_have_three_figures_and_a_unit(seconds: float | None, shown: str) -> None:
    assert seconds_text(seconds) == shown


async def test_a_key_brings_the_endpoints_to_the_front_and_back() -> None:
    look = Look((120, 40), "en")
    app = look.app("topics")
    async with app.run_test(size=look.size) as pilot:
        await settle(pilot)
        screen: Any = app.screen
        assert isinstance(screen, TopicsScreen)
        screen.table.choose("/drive")
        rows = [
            replace(row, published_by=(LIDAR,), subscribed_by=(BRAIN,))
            if row.name == "/drive"
            else row
            for row in TOPICS
        ]
        app.feed.graph.show(lesson_update(topics=tuple(rows)))  # type: ignore[union-attr]
        await pilot.press("enter", "I")
        await pilot.pause()
        assert screen.detail.endpoints.has_focus
        assert "/brain does not hear /lidar" in screen.detail.endpoints.text
        rows = [replace(row, published_by=(), subscribed_by=()) for row in TOPICS]
        app.feed.graph.show(lesson_update(topics=tuple(rows)))  # type: ignore[union-attr]
        await pilot.pause()
        assert "nobody publishes" in screen.detail.endpoints.text
        rows = [replace(row, own_publishers=1) for row in rows]
        app.feed.graph.show(lesson_update(topics=tuple(rows)))  # type: ignore[union-attr]
        await pilot.pause()
        assert "Deck itself publishes here" in screen.detail.endpoints.text
        await pilot.press("I")
        assert screen.detail.echo.has_focus
