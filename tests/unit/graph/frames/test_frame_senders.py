"""Who publishes a frame, as the messages tell by the identifiers of their publishers."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import pytest

from graph.data import FrameRow
from graph.frames.book import FrameBook
from graph.frames.senders import REPLACED_S
from tests.unit.transform_messages import Sent, cdr
from text.ros_names import TF, TF_STATIC

BEGIN_S = 1000.0


def gid(process: int, entity: int = 3) -> bytes:
    """As Fast DDS makes them: vendor, host and process, then the publisher in that process."""
    return b"\x01\x0fhost" + process.to_bytes(6, "little") + entity.to_bytes(4, "big")


A, B, C = gid(1), gid(2), gid(3)
ALL = {A: "/a", B: "/b", C: "/c"}


@pytest.fixture
def book() -> FrameBook:
    return FrameBook(_never)


def _never(raw: bytes) -> Mapping[str, Any]:
    raise AssertionError(f"these bytes should be read without rclpy: {raw!r}")


def send(
    book: FrameBook, sender: bytes, at_s: float, x: float = 0.0, *, static: bool = False
) -> None:
    raw = cdr(Sent("odom", "base", translation=(x, 0.0, 0.0)))
    book.take(TF_STATIC if static else TF, raw, at_s, 1, sender)


def seen(book: FrameBook, now_s: float, there: Mapping[bytes, str]) -> FrameRow:
    """The row of the frame while these are there."""
    for topic in (TF, TF_STATIC):
        book.published_by(topic, there, now_s)
    (found,) = book.rows(now_s)
    return found


def test_the_one_that_sends_it_is_its_publisher_whoever_else_is_there(book: FrameBook) -> None:
    send(book, B, BEGIN_S)
    found = seen(book, BEGIN_S, ALL)
    assert (found.publishers, found.certain) == (("/b",), True)


def test_until_the_endpoint_is_known_it_may_be_any(book: FrameBook) -> None:
    send(book, B, BEGIN_S)
    found = seen(book, BEGIN_S, {A: "/a", C: "/c"})
    assert (found.publishers, found.certain) == (("/a", "/c"), False)
    found = seen(book, BEGIN_S, {A: "/a", B: ""})
    assert (found.publishers, found.certain) == (("/a", "unknown node"), False)
    assert seen(book, BEGIN_S + 1, ALL).publishers == ("/b",)


def test_while_one_of_two_is_still_to_be_found_neither_passes_for_the_only_one(
    book: FrameBook,
) -> None:
    send(book, A, BEGIN_S)
    send(book, B, BEGIN_S + 1)
    send(book, A, BEGIN_S + 2)
    found = seen(book, BEGIN_S + 2, {A: "/a", C: "/c"})
    assert (found.publishers, found.certain) == (("/a", "/c"), False)
    found = seen(book, BEGIN_S + 3, ALL)
    assert (found.publishers, found.certain) == (("/a", "/b"), True)


def test_both_who_send_it_by_turns_are_named_and_said_to_fight(book: FrameBook) -> None:
    for turn in range(5):
        send(book, A, BEGIN_S + turn)
        send(book, C, BEGIN_S + turn + 0.5)
        found = seen(book, BEGIN_S + turn + 0.6, ALL)
    assert (found.publishers, found.certain) == (("/a", "/c"), True)
    assert found.contested
    # Then one of them gives up.
    for turn in range(10):
        send(book, C, BEGIN_S + 10 + turn)
        found = seen(book, BEGIN_S + 10 + turn, ALL)
    assert found.publishers == ("/c",)
    assert not found.contested


def test_a_node_that_is_started_anew_is_one_node(book: FrameBook) -> None:
    for static in (False, True):
        send(book, A, BEGIN_S, 1.0, static=static)
        book.clear()
        send(book, A, BEGIN_S, 1.0, static=static)
        # It was killed: for some time the graph has both.
        there = {A: "/a", gid(9): "/a"}
        send(book, gid(9), BEGIN_S + 2, 2.0, static=static)
        found = seen(book, BEGIN_S + 3, there)
        assert (found.publishers, found.certain) == (("/a",), True)
        assert not found.moved
        assert not found.contested
        book.clear()


def test_two_nodes_of_one_name_are_both_counted(book: FrameBook) -> None:
    there = {A: "/twin", B: "/twin"}
    for turn in range(3):
        send(book, A, BEGIN_S + turn)
        send(book, B, BEGIN_S + turn + 0.6)
    assert seen(book, BEGIN_S + 3, there).publishers == ("/twin", "/twin")


def test_two_latched_nodes_of_one_name_are_noticed_once_the_older_should_have_gone(
    book: FrameBook,
) -> None:
    there = {A: "/twin", B: "/twin"}
    send(book, A, BEGIN_S, 1.0, static=True)
    send(book, B, BEGIN_S + 5, 2.0, static=True)
    assert seen(book, BEGIN_S + 6, there).publishers == ("/twin",)
    found = seen(book, BEGIN_S + 6 + REPLACED_S, there)
    assert found.publishers == ("/twin", "/twin")
    assert found.moved


def test_two_publishers_of_one_node_are_one_node(book: FrameBook) -> None:
    for number in range(6):
        send(book, gid(1, 3 + number % 2), BEGIN_S + number / 10)
    there = {gid(1, 3): "/a", gid(1, 4): "/a", B: "/b"}
    assert seen(book, BEGIN_S + 1, there).publishers == ("/a",)


def test_two_latched_publishers_of_other_numbers_are_noticed_however_far_apart(
    book: FrameBook,
) -> None:
    send(book, A, BEGIN_S, 1.0, static=True)
    assert not seen(book, BEGIN_S + 1, ALL).moved
    send(book, B, BEGIN_S + 60, 2.0, static=True)
    found = seen(book, BEGIN_S + 60, ALL)
    assert (found.publishers, found.certain) == (("/a", "/b"), True)
    assert found.moved
    # As long as both are there.
    assert seen(book, BEGIN_S + 600, ALL).moved
    assert not seen(book, BEGIN_S + 601, {B: "/b"}).moved
    assert seen(book, BEGIN_S + 601, {B: "/b"}).publishers == ("/b",)


def test_two_latched_publishers_of_the_same_numbers_do_no_harm(book: FrameBook) -> None:
    # Each comes again whenever Deck subscribes anew.
    for turn in range(5):
        send(book, A, BEGIN_S + turn, 1.0, static=True)
        send(book, B, BEGIN_S + turn + 0.01, 1.0, static=True)
        found = seen(book, BEGIN_S + turn + 0.1, ALL)
    assert found.publishers == ("/a", "/b")
    assert not found.moved
    assert not found.contested


def test_who_has_gone_is_named(book: FrameBook) -> None:
    send(book, A, BEGIN_S, static=True)
    seen(book, BEGIN_S, ALL)
    found = seen(book, BEGIN_S + 1, {B: "/b"})
    assert (found.publishers, found.gone) == ((), "/a")
    send(book, B, BEGIN_S + 2, static=True)
    found = seen(book, BEGIN_S + 3, {B: "/b"})
    assert (found.publishers, found.gone) == (("/b",), "")


def test_where_identifiers_match_no_endpoint_those_that_may_be_are_named(book: FrameBook) -> None:
    # Cyclone DDS gives handles of its own: ros2/rmw_cyclonedds, issue 377.
    for turn in range(4):
        for one in (b"handle 1........", b"handle 2........"):
            send(book, one, BEGIN_S + turn, static=False)
            found = seen(book, BEGIN_S + turn, {A: "/a", B: "/b"})
    assert (found.publishers, found.certain) == (("/a", "/b"), False)
    assert found.contested


def test_a_flood_of_publishers_does_not_fill_the_memory(book: FrameBook) -> None:
    for number in range(5000):
        one = gid(number + 10)
        send(book, one, BEGIN_S + number / 1e4)
        found = seen(book, BEGIN_S + number / 1e4, {one: f"/node_{number}", A: "/a"})
    assert found.publishers == ("/node_4999",)
    records = book._records.values()
    assert all(len(one._senders._others) <= 20 for one in records)
    assert len(book._publishers[TF].known) <= 1002
