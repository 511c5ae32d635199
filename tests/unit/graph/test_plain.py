"""What goes between the screen and the observer's process: plain data, and nothing that runs."""

from __future__ import annotations

import os
import pickle
import socket
from collections.abc import Iterator
from dataclasses import replace
from enum import Enum
from typing import Any

import numpy as np
import pytest

from graph.data import (
    EndpointInfo,
    GoalStatus,
    GraphUpdate,
    NodeRow,
    Sample,
    TopicRow,
    Trouble,
    Value,
)
from graph.messages.making import NoSuchFieldError
from graph.messages.types import UnknownTypeError
from graph.observer.process.plain import PlainError, packed, plain_error, unpacked
from graph.observer.process.updates import Lengthener, Shortener
from graph.observer.process.wire import Wire
from graph.observer.requests import ObserverError
from text.i18n import localized
from text.sentences import say


def there_and_back(value: object) -> Any:
    return unpacked(b"".join(packed(value)))


def test_a_message_of_every_kind_of_value_comes_back_as_it_was() -> None:
    value: dict[str, Value] = {
        "a": 1,
        "b": 2.5,
        "c": "ä",
        "d": b"\0" * 100_000,
        "e": [{"x": True}],
        "f": [],
    }
    sample = Sample("/t", "a/msg/B", 1.0, 0.0, 10, value)
    assert there_and_back(sample) == sample


@pytest.mark.parametrize("kind", ["float32", "int64", "uint16", "bool"])
def test_arrays_of_numbers_come_back(kind: str) -> None:
    array = np.arange(5).astype(kind)
    back = there_and_back({"ranges": array})["ranges"]
    assert back.dtype == array.dtype
    assert back.tolist() == array.tolist()


def test_sentences_can_still_be_translated() -> None:
    words = there_and_back(say("ROS cannot be used: {error}", error="no rclpy"))
    assert localized(words, "ru") == "ROS не работает: no rclpy"


def test_errors_come_back_with_all_that_they_say() -> None:
    wrong = NoSuchFieldError("a.b", say("no such field; did you mean {name}?", name="c"))
    wrong.line = 3
    back = there_and_back(wrong)
    assert (type(back), back.field, back.message, back.line) == (
        NoSuchFieldError,
        "a.b",
        wrong.message,
        3,
    )
    unknown = there_and_back(UnknownTypeError("a/msg/B", "a", say("gone"), {"pip": "ros-a"}))
    assert (unknown.type_name, unknown.package, unknown.install) == (
        "a/msg/B",
        "a",
        {"pip": "ros-a"},
    )
    assert str(there_and_back(plain_error(RuntimeError("rcl says no")))) == "rcl says no"


class Harm:
    """As a hostile sender writes it."""

    def __init__(self, *call: Any) -> None:
        self.call = call

    def __reduce__(self) -> Any:
        return self.call


@pytest.mark.parametrize(
    "call",
    [(os.system, ("true",)), (eval, ("1",)), (getattr, (ObserverError, "mro")), (Wire, (None,))],
)
def test_what_names_anything_else_is_refused(call: Any) -> None:
    with pytest.raises(PlainError):
        unpacked(pickle.dumps(Harm(*call)))


@pytest.mark.parametrize("value", [object(), lambda: None, np.array([object()])])
def test_what_is_not_plain_is_refused_before_it_is_sent(value: object) -> None:
    with pytest.raises(PlainError):
        there_and_back(value)


ENDS = (EndpointInfo("/a", "std_msgs/msg/Bool", "reliable", "volatile", process=7),)


def row(name: str, hz: float | None = None) -> TopicRow:
    return TopicRow(name, ("std_msgs/msg/Bool",), 1, 0, hz=hz, published_by=ENDS)


def test_updates_come_back_and_what_has_not_changed_is_the_same_object() -> None:
    shortener, lengthener = Shortener(), Lengthener()
    first = GraphUpdate(1.0, (row("/a"), row("/b")), nodes=(NodeRow("/n"),))
    hot = replace(first.topics[0], hz=2.0, trouble=Trouble.QUIET)
    others = (
        first,
        replace(first, time_s=2.0, topics=(hot, first.topics[1])),
        replace(first, time_s=3.0, topics=(row("/0"), hot, first.topics[1]), nodes=()),
        replace(first, time_s=4.0, topics=(first.topics[1],)),
        replace(first, time_s=5.0, topics=(first.topics[1],), error="gone"),
    )
    back = [lengthener.update(there_and_back(shortener.shortened(each))) for each in others]
    assert back == list(others)
    assert back[1].topics[1] is back[0].topics[1] is back[4].topics[0]
    assert back[1].topics[0].published_by is back[0].topics[0].published_by
    assert back[1].nodes is back[0].nodes


def test_an_endpoint_that_was_replaced_by_one_like_it_is_told() -> None:
    shortener, lengthener = Shortener(), Lengthener()
    before = GraphUpdate(1.0, (row("/a"),))
    after = replace(
        before, topics=(replace(row("/a"), published_by=(replace(ENDS[0], process=8),)),)
    )
    for each in (before, after):
        back = lengthener.update(there_and_back(shortener.shortened(each)))
    assert back.topics[0].published_by[0].process == 8


@pytest.fixture
def wires() -> Iterator[tuple[Wire, Wire]]:
    ends = [Wire(end) for end in socket.socketpair()]
    yield ends[0], ends[1]
    for end in ends:
        end.close()


def test_packets_of_every_size_arrive_in_order_and_nobody_waits(wires: tuple[Wire, Wire]) -> None:
    here, there = wires
    sizes = [0, 1, 7, 65_535, 65_536, 65_537, 5_000_000, 3, 200_000]
    for size in sizes:
        here.send([b"x" * (size // 2), b"y" * (size - size // 2)])
    behind = here.is_behind
    got: list[bytearray] = []
    while len(got) < len(sizes):
        got += there.receive()
        here.flush()
    assert [len(packet) for packet in got] == sizes
    assert (behind, here.is_behind) == (True, False)
    assert bytes(got[3]) == b"x" * 32_767 + b"y" * 32_768


def test_the_end_of_the_other_side_is_told_after_its_last_words(wires: tuple[Wire, Wire]) -> None:
    here, there = wires
    here.send([b"bye"])
    here.close()
    assert there.receive() == [b"bye"]
    with pytest.raises(EOFError):
        there.receive()


def test_one_who_has_lost_the_thread_is_not_believed(wires: tuple[Wire, Wire]) -> None:
    here, there = wires
    here._socket.send(b"\xff" * 8)
    with pytest.raises(ConnectionError):
        there.receive()


def test_an_enumeration_goes_over_however_python_takes_it_apart(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Python 3.11.2, that of Debian 12, would name `getattr`; others name the class."""

    def by_name(member: Enum, _protocol: int) -> tuple[object, ...]:
        return getattr, (type(member), member.name)

    for kind in (Trouble, GoalStatus):
        monkeypatch.setattr(kind, "__reduce_ex__", by_name)
        for member in kind:
            assert there_and_back(member) is member
