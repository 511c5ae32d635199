"""What is counted of the frames on /tf and /tf_static, and who publishes them."""

from __future__ import annotations

import math
from collections.abc import Mapping

import pytest

from graph.data import FrameRow
from graph.frames.book import MOST_FRAMES, FrameBook
from tests.unit.transform_messages import NO_TURN, Sent, cdr
from text.ros_names import TF, TF_STATIC

BEGIN_S = 1000.0


@pytest.fixture
def book() -> FrameBook:
    return FrameBook()


def row(book: FrameBook, child: str, now_s: float = BEGIN_S, *, static: bool = False) -> FrameRow:
    (found,) = (row for row in book.rows(now_s) if row.newest.child == child and row.is_static == static)
    return found


def send(book: FrameBook, *sent: Sent, at_s: float = BEGIN_S, topic: str = TF, number: int | None = None) -> None:
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


def test_numbers_that_go_back_again_and_again_tell_of_two_publishers(book: FrameBook) -> None:
    for turn in range(10):
        at_s = BEGIN_S + turn / 10
        send(book, Sent("odom", "base_link"), at_s=at_s, number=100 + turn)
        send(book, Sent("odom", "base_link"), at_s=at_s + 0.05, number=3 + turn)
        send(book, Sent("base_link", "head"), at_s=at_s, number=500 + turn)
        book.rows(at_s)
    assert row(book, "base_link").contested
    assert not row(book, "head").contested


def test_room_is_limited_and_given_to_others_once_a_moving_frame_is_silent(book: FrameBook) -> None:
    send(book, *(Sent("odom", f"frame_{number}") for number in range(MOST_FRAMES + 500)))
    assert len(book.rows(BEGIN_S)) == MOST_FRAMES
    late = BEGIN_S + 30
    send(book, Sent("odom", "late"), at_s=late)
    assert len(book.rows(late)) == 0
    send(book, Sent("odom", "late"), at_s=late)
    assert row(book, "late", late).count == 1


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
def test_bytes_that_are_no_such_message_are_refused(book: FrameBook, raw: bytes) -> None:
    with pytest.raises(Exception):  # noqa: B017, PT011 - whatever; whoever feeds the book tells it
        book.take(TF, raw, BEGIN_S)
    assert book.rows(BEGIN_S) == ()


def gid(process: int, entity: int = 3) -> bytes:
    """As Fast DDS makes them: vendor, host and process, then the publisher in that process."""
    return b"\x01\x0fhost" + process.to_bytes(6, "little") + entity.to_bytes(4, "big")


A, B, C = gid(1), gid(2), gid(3)
ALL = {A: "/a", B: "/b", C: "/c"}


def send_frame_senders(book: FrameBook, sender: bytes, at_s: float, x: float = 0.0, *, static: bool = False) -> None:
    raw = cdr(Sent("odom", "base", translation=(x, 0.0, 0.0)))
    book.take(TF_STATIC if static else TF, raw, at_s, 1, sender)


def seen(book: FrameBook, now_s: float, there: Mapping[bytes, str]) -> FrameRow:
    """The row of the frame while these are there."""
    for topic in (TF, TF_STATIC):
        book.published_by(topic, there)
    (found,) = book.rows(now_s)
    return found


def test_both_who_send_it_by_turns_are_named_and_said_to_fight(book: FrameBook) -> None:
    for turn in range(5):
        send_frame_senders(book, A, BEGIN_S + turn)
        send_frame_senders(book, C, BEGIN_S + turn + 0.5)
        found = seen(book, BEGIN_S + turn + 0.6, ALL)
    assert (found.publishers, found.certain) == (("/a", "/c"), True)
    assert found.contested
    # Then one of them gives up.
    for turn in range(10):
        send_frame_senders(book, C, BEGIN_S + 10 + turn)
        found = seen(book, BEGIN_S + 10 + turn, ALL)
    assert found.publishers == ("/c",)
    assert not found.contested


def test_a_node_that_is_started_anew_is_one_node(book: FrameBook) -> None:
    for static in (False, True):
        send_frame_senders(book, A, BEGIN_S, 1.0, static=static)
        book.clear()
        send_frame_senders(book, A, BEGIN_S, 1.0, static=static)
        # It was killed: for some time the graph has both.
        there = {A: "/a", gid(9): "/a"}
        send_frame_senders(book, gid(9), BEGIN_S + 2, 2.0, static=static)
        found = seen(book, BEGIN_S + 3, there)
        assert (found.publishers, found.certain) == (("/a",), True)
        assert not found.moved
        assert not found.contested
        book.clear()


def test_two_latched_publishers_of_other_numbers_are_noticed_however_far_apart(book: FrameBook) -> None:
    send_frame_senders(book, A, BEGIN_S, 1.0, static=True)
    assert not seen(book, BEGIN_S + 1, ALL).moved
    send_frame_senders(book, B, BEGIN_S + 60, 2.0, static=True)
    found = seen(book, BEGIN_S + 60, ALL)
    assert (found.publishers, found.certain) == (("/a", "/b"), True)
    assert found.moved
    # As long as both are there.
    assert seen(book, BEGIN_S + 600, ALL).moved
    assert not seen(book, BEGIN_S + 601, {B: "/b"}).moved
    assert seen(book, BEGIN_S + 601, {B: "/b"}).publishers == ("/b",)
