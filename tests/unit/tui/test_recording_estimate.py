"""What a recording would take on the disk, by the rates of its topics; and when it ends."""

from __future__ import annotations

import math
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from graph.data import TopicRow
from graph.heavy_types import COMPRESSED_IMAGE, HEAVY_TYPES, IMAGE, POINT_CLOUD
from graph.recording.recorder import RecordingStatus
from text.i18n import set_language
from tui.bags.estimate import MESSAGE_BYTES, OTHERS, shares, total_rate
from tui.recording.wish import RecordingLimit, read_limit


def row(name: str, type_name: str, hz: float | None, size: int, **more: Any) -> TopicRow:
    measured = {"publishers": 1, "subscribers": 0, "measured": True, **more}
    rate = None if hz is None else hz * size
    return TopicRow(name, (type_name,), hz=hz, bytes_per_s=rate, **measured)


def test_each_heavy_type_has_its_share_and_all_others_one_together() -> None:
    found = shares(
        [
            row("/camera", IMAGE, 10.0, 1_000_000),
            row("/depth", IMAGE, 5.0, 500_000),
            row("/scan", POINT_CLOUD, 2.0, 300_000),
            row("/number", "std_msgs/msg/Float32", 100.0, 8),
            row("/map", "nav_msgs/msg/OccupancyGrid", None, 0),
            row("/go/_action/feedback", "x/action/Go_FeedbackMessage", 10.0, 100),
            row("/heard_by_nobody", IMAGE, 10.0, 1, publishers=0),
        ]
    )
    assert [share.type_name for share in found] == [*HEAVY_TYPES, OTHERS]
    by_type = {share.type_name: share for share in found}
    assert by_type[IMAGE].topics == ("/camera", "/depth")
    assert by_type[IMAGE].bytes_per_s == 12_500_000 + 15 * MESSAGE_BYTES
    assert by_type[COMPRESSED_IMAGE].topics == ()
    assert by_type[OTHERS].topics == ("/number", "/map")
    # Small messages take more for their envelope than for their content.
    assert by_type[OTHERS].bytes_per_s == 100 * (8 + MESSAGE_BYTES)
    assert total_rate(found, {IMAGE, POINT_CLOUD}) == 100 * (8 + MESSAGE_BYTES)


def test_what_is_not_measured_yet_is_unknown_unless_it_is_left_out() -> None:
    found = shares(
        [
            row("/camera", IMAGE, None, 0, measured=False),
            row("/number", "std_msgs/msg/Float32", 1.0, 8),
        ]
    )
    assert total_rate(found, set()) is None
    assert total_rate(found, {IMAGE}) == 8 + MESSAGE_BYTES
    assert total_rate(shares([]), set()) == 0.0


@pytest.mark.parametrize(
    ("text", "limit"),
    [
        ("", RecordingLimit()),
        ("10", RecordingLimit(seconds=600.0)),
        ("90 s", RecordingLimit(seconds=90.0)),
        (" 1,5 ч ", RecordingLimit(seconds=5400.0)),
        ("10 мин.", RecordingLimit(seconds=600.0)),
        ("500MB", RecordingLimit(bytes=500e6)),
        ("2.5 ГБ", RecordingLimit(bytes=2.5e9)),
    ],
)
def test_a_limit_is_read_in_both_languages(text: str, limit: RecordingLimit) -> None:
    assert read_limit(text) == limit


@pytest.mark.parametrize(
    "text", ["0", "-5", "soon", "10 parsecs", "nan", "inf", "1e9", "5 5", "MB"]
)
def test_anything_else_is_refused_with_examples(text: str) -> None:
    with pytest.raises(ValueError, match="10 min, 90 s, 1 h, 500 MB, 2 GB"):
        read_limit(text)
    set_language("ru")
    with pytest.raises(ValueError, match="10 мин"):
        read_limit(text)
    set_language("en")


@given(st.text(max_size=30))
def test_whatever_is_typed_is_a_limit_above_zero_or_refused(text: str) -> None:
    try:
        limit = read_limit(text)
    except ValueError:
        return
    assert limit.seconds > 0
    assert limit.bytes > 0


def test_a_limit_is_reached_by_time_or_by_size() -> None:
    status = RecordingStatus("", 0.0, seconds=60.0, bytes=1_000)
    assert not RecordingLimit().is_reached(status)
    assert RecordingLimit(seconds=60.0).is_reached(status)
    assert not RecordingLimit(seconds=60.5).is_reached(status)
    assert RecordingLimit(bytes=1_000).is_reached(status)
    assert not RecordingLimit(seconds=math.inf, bytes=1_001).is_reached(status)
