"""Only messages for which an expression holds, on the screen of topics."""

from __future__ import annotations

from collections.abc import AsyncIterator

import pytest
from textual.widgets import Static

from graph.data import GraphUpdate
from tests.tui.recorded import lesson_update, sample
from tests.tui.topics_room import SONAR, Room, opened


def sonar(*metres: float) -> GraphUpdate:
    """So many messages of the sonar in one update."""
    values = tuple(sample(SONAR, "std_msgs/msg/Float32", {"data": each}) for each in metres)
    return lesson_update(samples={SONAR: values})


async def only_if(room: Room, expression: str) -> None:
    """Choose the sonar, and let only messages through for which this holds."""
    await room.choose(SONAR)
    await room.pilot.press("f")
    field = room.screen.detail.filter.field
    assert field.has_focus
    field.value = expression
    await room.pilot.pause()
    await room.pilot.pause()


def filter_line(room: Room) -> str:
    """What is said beside the expression."""
    return str(room.screen.query_one(".filter-told", Static).content)


@pytest.fixture
async def room() -> AsyncIterator[Room]:
    async with opened() as room:
        yield room


async def test_only_messages_are_shown_for_which_the_expression_holds(room: Room) -> None:
    await only_if(room, "m.data > 0.5")
    # Each message is looked at, not the newest of an update alone.
    assert SONAR in room.graph.followed
    await room.show(sonar(0.7, 0.2, 0.3))
    assert "0.7" in room.echo()
    assert filter_line(room) == "1 of 3 messages"
    await room.show(sonar(0.1))
    assert "0.7" in room.echo()
    await room.show(sonar(0.9))
    assert "0.9" in room.echo()
    assert filter_line(room) == "2 of 5 messages"


async def test_a_message_that_does_not_fit_goes_out_of_sight_and_comes_back(room: Room) -> None:
    await room.choose(SONAR)
    await room.show(sonar(0.25))
    assert "0.25" in room.echo()
    await only_if(room, "m.data > 0.5")
    assert room.echo().splitlines()[0] == "no message fits the expression yet"
    assert "0 of 1 message" in room.echo()
    await room.pilot.press("escape")
    assert "0.25" in room.echo()
    assert not room.screen.detail.filter.display
    assert SONAR not in room.graph.followed


async def test_each_topic_has_its_own_expression(room: Room) -> None:
    await only_if(room, "m.data > 0.5")
    room.screen.table.focus()
    await room.choose("/drive")
    assert not room.screen.detail.filter.display
    await room.show(lesson_update())
    assert "speed" in room.echo()
    await room.choose(SONAR)
    assert room.screen.detail.filter.field.value == "m.data > 0.5"
    await room.show(sonar(0.1, 0.8))
    assert "0.8" in room.echo()
    assert filter_line(room) == "1 of 2 messages"


async def test_an_expression_that_is_wrong_names_the_place_and_lets_nothing_through(
    room: Room,
) -> None:
    await room.choose(SONAR)
    await only_if(room, "m.data > 0.5 and data")
    told = "✗ column 18: data: the message is called m: write m.data"
    assert filter_line(room) == told
    await room.show(sonar(0.8))
    assert filter_line(room) == told
    assert "the expression is wrong" in room.echo()


async def test_a_field_that_is_missing_is_told_once_and_counted(room: Room) -> None:
    await only_if(room, "m.dat > 0.5")
    await room.show(sonar(0.8, 0.9))
    await room.show(sonar(0.8))
    told = "0 of 3 messages · ✗ column 1: m.dat: no such field; did you mean data? (×3)"
    assert filter_line(room) == told
    assert not room.app._notifications


async def test_what_fits_while_another_screen_is_in_front_is_seen_when_one_comes_back(
    room: Room,
) -> None:
    await only_if(room, "m.data > 5")
    await room.app.show_screen("logs")
    assert SONAR in room.graph.followed
    await room.show(sonar(7.5, 0.1))
    await room.app.show_screen("topics")
    await room.show(sonar(0.2))
    assert "7.5" in room.echo()
    assert filter_line(room) == "1 of 3 messages"
