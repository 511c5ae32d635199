"""Updates that wait for the app are one, and do not grow without bounds."""

from __future__ import annotations

from graph.data import GraphUpdate, Sample
from graph.observer.merging import KEPT_BYTES, KEPT_SAMPLES
from tui.session.inbox import GraphInbox


def put(inbox: GraphInbox, number: int, size_bytes: int = 8) -> None:
    said = Sample("/cloud", "a/msg/B", float(number), 0.0, size_bytes, {})
    inbox.put(GraphUpdate(float(number), samples={"/cloud": (said,)}))


def test_those_that_wait_become_one_and_wake_once() -> None:
    woken: list[int] = []
    inbox = GraphInbox(lambda: woken.append(1))
    for number in range(3):
        put(inbox, number)
    update = inbox.take()
    assert update is not None
    assert update.time_s == 2.0
    assert [said.received_s for said in update.samples["/cloud"]] == [0.0, 1.0, 2.0]
    assert woken == [1]
    assert inbox.take() is None


def test_many_and_large_messages_do_not_pile_up() -> None:
    inbox = GraphInbox(lambda: None)
    for number in range(2 * KEPT_SAMPLES):
        put(inbox, number)
    update = inbox.take()
    assert update is not None
    assert len(update.samples["/cloud"]) == KEPT_SAMPLES
    for number in range(50):
        put(inbox, number, 5_000_000)
    update = inbox.take()
    assert update is not None
    waiting = update.samples["/cloud"]
    assert 1 < len(waiting) <= KEPT_BYTES // 5_000_000
    assert waiting[-1].received_s == 49.0
    for number in range(3):
        put(inbox, number, 2 * KEPT_BYTES)
    update = inbox.take()
    assert update is not None
    assert [said.received_s for said in update.samples["/cloud"]] == [2.0]
