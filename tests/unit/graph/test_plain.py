"""What goes between the screen and the observer's process: plain data, and nothing that runs."""

from __future__ import annotations

import os
import pickle
import socket
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from graph.data import Sample, Value
from graph.messages.making import NoSuchFieldError
from graph.messages.types import UnknownTypeError
from graph.observer.process.plain import PlainError, packed, plain_error, unpacked
from graph.observer.process.wire import Wire
from graph.observer.requests import ObserverError
from text.sentences import say


def there_and_back(value: object) -> Any:
    return unpacked(b"".join(packed(value)))


def test_a_message_of_every_kind_of_value_comes_back_as_it_was() -> None:
    value: dict[str, Value] = {"a": 1, "b": 2.5, "c": "ä", "d": b"\0" * 100_000, "e": [{"x": True}], "f": []}
    sample = Sample("/t", "a/msg/B", 1.0, 0.0, 10, value)
    assert there_and_back(sample) == sample


def test_errors_come_back_with_all_that_they_say() -> None:
    wrong = NoSuchFieldError("a.b", say("no such field; did you mean {name}?", name="c"))
    wrong.line = 3
    back = there_and_back(wrong)
    assert (type(back), back.field, back.message, back.line) == (NoSuchFieldError, "a.b", wrong.message, 3)
    unknown = there_and_back(UnknownTypeError("a/msg/B", "a", say("gone"), {"pip": "ros-a"}))
    assert (unknown.type_name, unknown.package, unknown.install) == ("a/msg/B", "a", {"pip": "ros-a"})
    assert str(there_and_back(plain_error(RuntimeError("rcl says no")))) == "rcl says no"


class Harm:
    """As a hostile sender writes it."""

    def __init__(self, *call: Any) -> None:
        self.call = call

    def __reduce__(self) -> Any:
        return self.call


@pytest.mark.parametrize(
    "call", [(os.system, ("true",)), (eval, ("1",)), (getattr, (ObserverError, "mro")), (Wire, (None,))]
)
def test_what_names_anything_else_is_refused(call: Any) -> None:
    with pytest.raises(PlainError):
        unpacked(pickle.dumps(Harm(*call)))


@pytest.mark.parametrize("value", [object(), lambda: None, np.array([object()])])
def test_what_is_not_plain_is_refused_before_it_is_sent(value: object) -> None:
    with pytest.raises(PlainError):
        there_and_back(value)


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
