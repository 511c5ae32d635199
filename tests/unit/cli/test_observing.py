"""What a command takes the graph of a domain to be, of which it is told little by little."""

from __future__ import annotations

import queue
import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

import pytest

import cli.diagnostics
import cli.doctor.graph
import cli.observing
from cli.observing import DomainView
from graph.data import GraphUpdate, NodeRow, Sample, Value
from graph.observer.observer import Observer
from launcher.errors import UsageError
from robot.topics import DIAGNOSTICS

SOON_S = 0.2
"""In the place of the seconds in which somebody is found."""
LATE_S = 3 * SOON_S
REST_S = 10 * SOON_S
"""In the place of those in which nothing new is found: on a busy machine the parts come late."""


@pytest.fixture(autouse=True)
def _hasty(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cli.observing, "FOUND_S", SOON_S)
    monkeypatch.setattr(cli.diagnostics, "FOUND_S", SOON_S)
    monkeypatch.setattr(cli.doctor.graph, "LISTEN_S", SOON_S)


def with_nodes(count: int, **more: object) -> GraphUpdate:
    """The graph with so many nodes."""
    nodes = tuple(NodeRow(f"/n{number}") for number in range(count))
    return GraphUpdate(0.0, nodes=nodes, **more)  # type: ignore[arg-type]


@contextmanager
def told(*updates: GraphUpdate, each_s: float) -> Iterator[DomainView]:
    """A view of a domain that is told of these, one after the other."""
    arriving: queue.SimpleQueue[GraphUpdate] = queue.SimpleQueue()

    def tell(all_of_them: Sequence[GraphUpdate]) -> None:
        for update in all_of_them:
            time.sleep(each_s)
            arriving.put(update)

    telling = threading.Thread(target=tell, args=(updates,))
    telling.start()
    try:
        yield DomainView(7, "subnet", Observer(7), arriving)
    finally:
        telling.join()


def test_a_node_is_waited_for_as_long_as_a_peer_takes_to_be_found_however_late_it_begins() -> None:
    """On a busy machine the observer itself takes longer than that until it is in the domain."""
    with told(with_nodes(1), with_nodes(2), each_s=LATE_S) as view:
        assert not view.finds("/n1"), "it came later than a peer does"
    with told(with_nodes(2), each_s=LATE_S) as view:
        assert view.finds("/n1")


def test_a_graph_is_examined_whole_though_it_is_found_late_and_in_parts(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(cli.observing, "FOUND_S", REST_S)
    parts = [with_nodes(count) for count in (0, 3, 6, 9, 12, 16)]
    with told(*parts, each_s=SOON_S) as view:
        examined = cli.doctor.graph._examined(view)
    assert len(examined.update.nodes) == 16


def test_whoever_begins_late_has_not_found_nobody() -> None:
    status: Value = {
        "level": 0,
        "name": "arm",
        "message": "at rest",
        "hardware_id": "",
        "values": [],
    }
    one = Sample(DIAGNOSTICS, "x", time.time(), 0.0, 9, {"status": [status]})
    heard = with_nodes(1, samples={DIAGNOSTICS: (one,)})
    with told(heard, each_s=LATE_S) as view:
        book = cli.diagnostics._heard(view, 0.1)
    assert [record.status.name for record in book.records] == ["arm"]


def test_where_nothing_is_told_at_all_the_wait_has_an_end(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cli.observing, "BEGIN_S", LATE_S)
    with told(each_s=0.0) as view, pytest.raises(UsageError, match="no node was found"):
        cli.diagnostics._heard(view, 0.1)
