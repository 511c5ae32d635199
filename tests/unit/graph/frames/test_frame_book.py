"""What is counted of the frames on /tf and /tf_static: rates, faults, names, publishers, limits."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import pytest

from graph.data import FrameRow
from graph.frames.book import MOST_FRAMES, FrameBook
from graph.frames.reading import TransformReader
from tests.unit.transform_messages import NO_TURN, Sent, cdr
from text.ros_names import TF, TF_STATIC

BEGIN_S = 1000.0


@pytest.fixture
def book() -> FrameBook:
    return FrameBook(_never)


def _never(raw: bytes) -> Mapping[str, Any]:
    raise AssertionError(f"these bytes should be read without rclpy: {raw!r}")


def row(book: FrameBook, child: str, now_s: float = BEGIN_S, *, static: bool = False) -> FrameRow:
    (found,) = (
        row for row in book.rows(now_s) if row.newest.child == child and row.is_static == static
    )
    return found


def send(
    book: FrameBook, *sent: Sent, at_s: float = BEGIN_S, topic: str = TF, number: int | None = None
) -> None:
    book.take(topic, cdr(*sent), at_s, number)


def test_every_frame_of_every_message_has_its_place_rate_and_age(book: FrameBook) -> None:
    for turn in range(51):
        at_s = BEGIN_S + turn / 10
        send(book, Sent("odom", "base_link", at_s - 0.02, (turn, 2.0, 3.0)), at_s=at_s)
        if turn % 2 == 0:
            send(book, Sent("base_link", "head", at_s), Sent("head", "eye", at_s), at_s=at_s)
        # All that comes between two looks is counted, not only the newest.
        if turn % 5 == 0:
            book.rows(at_s)
    base = row(book, "base_link", BEGIN_S + 6.0)
    assert base.newest.transform.translation == (50.0, 2.0, 3.0)
    assert base.newest.stamp_s == pytest.approx(BEGIN_S + 5.0 - 0.02)
    assert base.count == 51
    assert base.hz == pytest.approx(10.0)
    assert base.age_s == pytest.approx(1.0)
    assert base.delay_s == pytest.approx(0.02)
    assert row(book, "eye").hz == pytest.approx(5.0)
    assert [one.newest.child for one in book.rows(BEGIN_S)] == ["base_link", "eye", "head"]


def test_a_frame_is_listed_once_for_each_parent_and_each_topic(book: FrameBook) -> None:
    send(book, Sent("odom", "base_link"))
    send(book, Sent("map", "base_link"))
    send(book, Sent("odom", "base_link"), topic=TF_STATIC)
    listed = [(one.newest.parent, one.is_static) for one in book.rows(BEGIN_S)]
    assert listed == [("map", False), ("odom", False), ("odom", True)]
    assert row(book, "base_link", static=True).hz is None


@pytest.mark.parametrize(
    ("sent", "said"),
    [
        (Sent("a", "b", translation=(math.nan, 0.0, 0.0)), "translation is not finite: nan, 0, 0"),
        (Sent("a", "b", translation=(0.0, math.inf, 0.0)), "translation is not finite: 0, inf, 0"),
        (Sent("a", "b", rotation=(0.0, 0.0, math.nan, 1.0)), "quaternion is not finite"),
        (Sent("a", "b", rotation=(0.0, 0.0, 0.0, 0.0)), "all zeros"),
        (Sent("a", "b", rotation=(0.0, 0.0, 1.0, 1.0)), "the length 1.414 in place of 1"),
        (Sent("a", "a"), "its own parent"),
        (Sent("/a", "a"), "its own parent"),
        (Sent("a", ""), "child_frame_id is empty"),
        (Sent("", "b"), "header.frame_id is empty"),
        (Sent("a", "b" * 201), "201 characters"),
    ],
)
def test_what_is_no_transform_is_not_taken_and_said(book: FrameBook, sent: Sent, said: str) -> None:
    send(book, sent)
    (found,) = book.rows(BEGIN_S)
    assert said in found.fault
    assert found.faults == found.count == 1
    assert found.newest.transform.rotation == NO_TURN


def test_a_fault_among_good_ones_is_said_for_a_while_and_the_good_one_is_kept(
    book: FrameBook,
) -> None:
    send(book, Sent("a", "b", translation=(1.0, 0.0, 0.0)))
    send(book, Sent("a", "b", translation=(math.nan, 0.0, 0.0)))
    send(book, Sent("a", "b", translation=(2.0, 0.0, 0.0)))
    found = row(book, "b", BEGIN_S + 1)
    assert found.newest.transform.translation == (2.0, 0.0, 0.0)
    assert (found.faults, found.count) == (1, 3)
    assert "nan" in found.fault
    assert not row(book, "b", BEGIN_S + 20).fault


def test_a_quaternion_as_long_as_tf2_allows_is_taken_and_scaled(book: FrameBook) -> None:
    send(book, Sent("a", "b", rotation=(0.0, 0.0, 0.0, 1.004)))
    found = row(book, "b")
    assert not found.fault
    assert found.newest.transform.rotation == NO_TURN


def test_a_leading_slash_is_taken_away_and_told(book: FrameBook) -> None:
    send(book, Sent("/odom", "/base_link"), Sent("base_link", "head"))
    assert row(book, "base_link").newest.parent == "odom"
    assert row(book, "base_link").slashed
    assert not row(book, "head").slashed


def test_numbers_that_go_back_again_and_again_tell_of_two_publishers(book: FrameBook) -> None:
    for turn in range(10):
        at_s = BEGIN_S + turn / 10
        send(book, Sent("odom", "base_link"), at_s=at_s, number=100 + turn)
        send(book, Sent("odom", "base_link"), at_s=at_s + 0.05, number=3 + turn)
        send(book, Sent("base_link", "head"), at_s=at_s, number=500 + turn)
        book.rows(at_s)
    assert row(book, "base_link").contested
    assert not row(book, "head").contested


def test_a_publisher_that_is_started_anew_is_not_taken_for_two(book: FrameBook) -> None:
    for number in (7, 8, 9, 1, 2, 3):
        send(book, Sent("odom", "base_link"), number=number)
        book.rows(BEGIN_S)
    assert not row(book, "base_link").contested


def send_static(book: FrameBook, x: float, at_s: float, number: int) -> bool:
    """Send it with this place, and return whether it is said to have moved."""
    sent = Sent("a", "b", translation=(x, 0.0, 0.0))
    send(book, sent, at_s=at_s, topic=TF_STATIC, number=number)
    return row(book, "b", at_s, static=True).moved


def test_a_static_frame_that_keeps_changing_has_moved(book: FrameBook) -> None:
    moved = [send_static(book, number, BEGIN_S + number / 10, number) for number in range(1, 7)]
    assert moved == [False, False, False, True, True, True]
    assert not row(book, "b", BEGIN_S + 20, static=True).moved


def test_a_parameter_that_is_set_and_a_node_that_is_restarted_move_no_static_frame(
    book: FrameBook,
) -> None:
    assert not send_static(book, 1.0, BEGIN_S, number=1)
    assert not send_static(book, 2.0, BEGIN_S + 1, number=2)
    assert not send_static(book, 3.0, BEGIN_S + 2, number=1)
    # What is latched comes again once Deck subscribes anew.
    assert not send_static(book, 3.0, BEGIN_S + 2.1, number=1)


def test_two_latched_messages_that_come_together_with_other_numbers_are_of_two_nodes(
    book: FrameBook,
) -> None:
    assert not send_static(book, 1.0, BEGIN_S, number=1)
    assert send_static(book, 2.0, BEGIN_S + 0.1, number=1)


def publishers(book: FrameBook, child: str, now_s: float, *nodes: str) -> tuple[str, ...]:
    book.published_by(TF, {node.encode(): node for node in nodes}, now_s)
    return row(book, child, now_s).publishers


def test_whoever_was_not_there_while_a_frame_came_is_not_its_publisher(book: FrameBook) -> None:
    send(book, Sent("odom", "base_link"))
    assert publishers(book, "base_link", BEGIN_S, "/a") == ("/a",)
    # Endpoints become known a little later than their messages.
    assert publishers(book, "base_link", BEGIN_S + 1, "/a", "/b") == ("/a", "/b")
    assert publishers(book, "base_link", BEGIN_S + 9, "/a", "/b", "/c") == ("/a", "/b")
    # A message that came just before its publisher left does not say that others sent it.
    send(book, Sent("odom", "base_link"), at_s=BEGIN_S + 9.9)
    assert publishers(book, "base_link", BEGIN_S + 10, "/a", "/c") == ("/a", "/b")
    send(book, Sent("odom", "base_link"), at_s=BEGIN_S + 15)
    assert publishers(book, "base_link", BEGIN_S + 15, "/a", "/c") == ("/a",)


def test_a_frame_whose_publishers_have_all_gone_has_none_until_it_comes_again(
    book: FrameBook,
) -> None:
    send(book, Sent("odom", "base_link"))
    publishers(book, "base_link", BEGIN_S, "/a")
    assert publishers(book, "base_link", BEGIN_S + 9, "/b") == ()
    assert publishers(book, "base_link", BEGIN_S + 10, "/b") == ()
    send(book, Sent("odom", "base_link"), at_s=BEGIN_S + 11)
    assert publishers(book, "base_link", BEGIN_S + 12, "/b") == ("/b",)


def test_room_is_limited_and_given_to_others_once_a_moving_frame_is_silent(book: FrameBook) -> None:
    send(book, *(Sent("odom", f"frame_{number}") for number in range(MOST_FRAMES + 500)))
    assert len(book.rows(BEGIN_S)) == MOST_FRAMES
    late = BEGIN_S + 30
    send(book, Sent("odom", "late"), at_s=late)
    assert len(book.rows(late)) == 0
    send(book, Sent("odom", "late"), at_s=late)
    assert row(book, "late", late).count == 1


def test_names_without_end_do_not_fill_the_memory(book: FrameBook) -> None:
    for number in range(300):
        send(book, Sent("a", "b" * 10_000 + str(number)), at_s=BEGIN_S + number / 1000)
    kept = book.rows(BEGIN_S + 1)
    assert max(len(one.newest.child) for one in kept) <= 200


def test_names_are_taken_apart_only_once() -> None:
    reader = TransformReader(_never)
    first, other, again = (
        reader.read(cdr(Sent("odom", child, at_s), Sent("base", "b", at_s), filler=filler)).names
        for child, at_s, filler in (("a", 1.0, b"x"), ("c", 2.0, b"y"), ("a", 3.0, b"z"))
    )
    assert first == (("odom", "a"), ("base", "b"))
    assert other == (("odom", "c"), ("base", "b"))
    assert again is first


@pytest.mark.parametrize(
    "raw",
    [
        b"",
        b"\x00\x01\x00\x00",
        b"\x00\x01\x00\x00\xff\xff\xff\xff",
        cdr(Sent("odom", "base_link"))[:-1],
        cdr(Sent("odom", "base_link"))[:30],
        b"\x00\x01\x00\x00\x01\x00\x00\x00" + b"\xff" * 100,
    ],
    ids=["nothing", "no count", "too many", "cut by a byte", "cut in a name", "endless names"],
)
def test_bytes_that_are_no_such_message_are_refused(raw: bytes) -> None:
    reader = TransformReader(_refuse)
    with pytest.raises(ValueError, match=r"too early|no message"):
        reader.read(raw)


def _refuse(raw: bytes) -> Mapping[str, Any]:
    del raw
    raise ValueError("no message")
