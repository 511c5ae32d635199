"""Service clients: kept while they are used, and trusted only when they can have been found."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import pytest

from graph.calls import clients
from graph.calls.clients import KEPT, SETTLE_S, Clients

TYPE = "rcl_interfaces/srv/ListParameters"


class Client:
    """Is there when it is told to be."""

    def __init__(self, service: str) -> None:
        self.service = service
        self.ready = False

    def service_is_ready(self) -> bool:
        return self.ready


class Node:
    """Remembers what was made and what was destroyed."""

    def __init__(self) -> None:
        self.open: list[str] = []

    def create_client(self, _type: Any, service: str) -> Client:
        self.open.append(service)
        return Client(service)

    def destroy_client(self, client: Client) -> None:
        self.open.remove(client.service)


@pytest.fixture
def node() -> Node:
    return Node()


@pytest.fixture
def kept(node: Node) -> Clients:
    return Clients(cast("Any", node))


def test_those_used_longest_ago_are_closed_first(node: Node, kept: Clients) -> None:
    busy = [kept.get("/busy", TYPE, ())]
    for number in range(KEPT - 1):
        kept.get(f"/s{number}", TYPE, busy)
    assert len(node.open) == KEPT
    kept.get("/s0", TYPE, busy)
    kept.get("/one more", TYPE, busy)
    kept.get("/and another", TYPE, busy)
    assert {"/busy", "/s0", "/one more", "/and another"} <= set(node.open)
    assert "/s1" not in node.open
    assert len(node.open) <= KEPT + 1


def test_a_service_is_trusted_a_little_after_it_was_found(
    kept: Clients, monkeypatch: pytest.MonkeyPatch
) -> None:
    now_s = 100.0
    monkeypatch.setattr(clients, "time", SimpleNamespace(monotonic=lambda: now_s))
    client: Any = kept.get("/s", TYPE, ())
    assert not kept.is_ready(client)
    client.ready = True
    assert not kept.is_ready(client)
    now_s += 2 * SETTLE_S
    assert kept.is_ready(client)
    # It went and came back: another one, perhaps.
    client.ready = False
    assert not kept.is_ready(client)
    client.ready = True
    assert not kept.is_ready(client)
