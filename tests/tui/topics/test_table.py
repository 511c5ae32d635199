"""The table of topics and its endpoints: figures in words, order, choice, what an update draws."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import pytest
from rich.cells import cell_len
from textual.geometry import Region

from graph.data import EndpointInfo, TopicRow, Trouble
from tests.tui.panel_stage import Bare
from tests.tui.recorded import TOPICS, topic
from tests.tui.snapshots import seen
from text.i18n import _, set_language
from tui.topics.endpoints import endpoint_lines
from tui.topics.table import COLUMNS, TopicsOrder, TopicsTable, age_text, bandwidth_text, fitting, state_text

FLOAT = "std_msgs/msg/Float32"


@pytest.mark.parametrize(
    ("more", "shown"),
    [
        ({"trouble": Trouble.NO_PUBLISHER}, "○ no publisher"),
        ({"trouble": Trouble.QOS_MISMATCH}, "✗ QoS mismatch"),
        ({"trouble": Trouble.UNKNOWN_TYPE}, "? unknown type"),
        ({"trouble": Trouble.QUIET, "age_s": 12.3}, "· 12 s ago"),
        ({"trouble": Trouble.QUIET, "age_s": None}, "· waiting"),
        ({"measured": False, "hz": None}, "– not measured"),
        ({"age_s": None, "hz": None}, "· waiting"),
        ({"detail": "peers disagree"}, "! peers disagree"),
        ({"detail": "peers disagree", "type_names": ("a", "b")}, "! types differ"),
        ({}, ""),
    ],
)
def test_the_last_column_says_why_figures_are_missing(more: dict[str, Any], shown: str) -> None:
    assert state_text(replace(topic("/a", FLOAT, 1.0), **more)) == shown


@pytest.mark.parametrize("language", ["en", "ru"])
def test_titles_and_states_fit_their_columns_in_every_language(language: str) -> None:
    set_language(language)
    by_id = {column.id: column for column in COLUMNS}
    for column in COLUMNS:
        assert not column.width or len(_(column.title) + "▲") <= column.width
    for trouble in Trouble:
        assert len(state_text(topic("/a", FLOAT, 1.0, trouble=trouble))) <= by_id["state"].width
    old = topic("/a", FLOAT, 1.0, trouble=Trouble.QUIET, age_s=3599.0)
    assert len(state_text(old)) <= by_id["state"].width
    assert len(state_text(topic("/a", FLOAT, 1.0, measured=False))) <= by_id["state"].width
    assert len(age_text(3599.0)) <= by_id["age"].width
    assert len(bandwidth_text(999_499.0)) <= by_id["bandwidth"].width


@pytest.mark.parametrize("width", range(1, 220, 7))
def test_columns_fit_and_the_name_is_always_there(width: int) -> None:
    fits = fitting(width)
    assert fits[0][0].id == "name"
    assert sum(wide + 1 for _column, wide in fits) - 1 <= width


def test_rows_are_sorted_by_any_column_and_equal_ones_by_name() -> None:
    rows = [topic("/c", FLOAT, 5.0), topic("/b", FLOAT, None, age_s=None), topic("/a", FLOAT, 5.01)]
    assert [row.name for row in TopicsOrder().arranged(rows)] == ["/a", "/b", "/c"]
    assert [row.name for row in TopicsOrder().by("hz").arranged(rows)] == ["/a", "/c", "/b"]
    assert [row.name for row in TopicsOrder().by("age").arranged(rows)] == ["/a", "/c", "/b"]


async def test_the_first_topic_is_chosen_and_keys_choose_another() -> None:
    table = TopicsTable()
    async with Bare(table).run_test(size=(80, 12)) as pilot:
        table.show_topics(TOPICS)
        table.focus()
        await pilot.press("down", "down", "up", "end", "home", "pagedown")
        await pilot.pause()
        assert table.chosen == "/wheel_commands"
        assert "▶ /wheel_commands" in seen(pilot.app)


async def test_the_chosen_topic_stays_chosen_when_rows_come_and_the_order_changes() -> None:
    table = TopicsTable()
    async with Bare(table).run_test(size=(80, 12)) as pilot:
        table.show_topics(TOPICS)
        table.choose("/drive")
        table.show_topics([topic("/aaa", FLOAT, 1.0), *TOPICS])
        table.reorder(TopicsOrder().by("hz"))
        await pilot.pause()
        assert table.chosen == "/drive"
        assert "▶ /drive " in seen(pilot.app)


async def test_a_click_on_a_title_sorts_and_a_click_on_a_row_chooses() -> None:
    table = TopicsTable()
    async with Bare(table).run_test(size=(120, 20)) as pilot:
        table.show_topics(TOPICS)
        await pilot.pause()
        header = seen(pilot.app).splitlines()[0]
        await pilot.click(TopicsTable, offset=(header.index("Hz"), 0))
        assert table.order.column_id == "hz"
        assert "Hz▼" in seen(pilot.app).splitlines()[0]
        await pilot.click(TopicsTable, offset=(10, 3))
        assert table.chosen == table.shown[2].name


@pytest.mark.every_frame
async def test_an_update_draws_only_the_cells_whose_text_changed(monkeypatch: pytest.MonkeyPatch) -> None:
    table = TopicsTable()
    async with Bare(table).run_test(size=(80, 20)) as pilot:
        table.show_topics(TOPICS)
        await pilot.pause()
        asked: list[Region] = []
        monkeypatch.setattr(table, "refresh", lambda *regions, **_options: asked.extend(regions))
        table.show_topics([replace(row, count=row.count + 1) for row in TOPICS])
        assert asked == []
        faster = [replace(row, hz=11.0) if row.name == "/drive" else row for row in TOPICS]
        table.show_topics(faster)
        hz = [column.id for column in table._fitting].index("hz")
        row = [row.name for row in table.shown].index("/drive")
        left = 2 + sum(width + 1 for width in table._widths[:hz])
        assert asked == [Region(left, 1 + row, table._widths[hz], 1)]


DOUBLE = "std_msgs/msg/Float64"
LIDAR = EndpointInfo("/lidar", FLOAT, "best_effort", "volatile", 5, "keep_last", 0.1, 0.5, 2.0, "manual_by_topic")
BRAIN = EndpointInfo("/brain", FLOAT, "reliable", "volatile", liveliness="automatic")


def a_row(published_by: Sequence[EndpointInfo] = (), subscribed_by: Sequence[EndpointInfo] = ()) -> TopicRow:
    ends = {"published_by": tuple(published_by), "subscribed_by": tuple(subscribed_by)}
    return TopicRow("/scan", (FLOAT,), len(published_by), len(subscribed_by), **ends)  # type: ignore[arg-type]


def text_of(row: TopicRow, width: int = 120) -> str:
    lines = ["".join(ink.text for ink in line) for line in endpoint_lines(row, width)]
    assert all(cell_len(line) <= width for line in lines)
    return "\n".join(" ".join(line.split()) for line in lines)


def test_every_policy_is_shown() -> None:
    shown = text_of(a_row([LIDAR], [replace(BRAIN, reliability="best_effort")]))
    assert "✓ every subscriber hears every publisher" in shown
    assert ("/lidar best_effort volatile keep_last 5 100 ms 500 ms manual_by_topic 2.0 s") in shown
    assert "/brain best_effort volatile – none none automatic" in shown
    assert "“–” is unknown" in shown


def test_a_pair_that_does_not_fit_is_marked_and_told_with_the_way_out() -> None:
    shown = text_of(a_row([LIDAR], [BRAIN]))
    words = "✗ /brain does not hear /lidar: reliability reliable is asked for, best_effort is"
    assert words in shown.replace("\n", " ")
    assert "\n✗ /lidar best_effort" in shown
    assert "\n✗ /brain reliable" in shown
    assert "✓" not in shown


def test_who_disagrees_about_the_type_is_named_and_no_qos_is_held_against_it() -> None:
    shown = text_of(a_row([LIDAR], [replace(BRAIN, type_name=DOUBLE)]))
    assert "✗ The endpoints use different types" in shown
    assert f"{FLOAT}: published by lidar" in shown
    assert f"{DOUBLE}: expected by brain" in shown
    assert "does not hear" not in shown
