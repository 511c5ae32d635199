"""Deck's service clients: created when needed, kept while in use."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from graph.messages.types import load_service

if TYPE_CHECKING:
    from collections.abc import Container

    from rclpy.client import Client
    from rclpy.node import Node

KEPT = 32
"""Looking at the parameters of a hundred nodes must not leave three hundred clients behind."""
SETTLE_S = 0.1
"""A service is discovered here before it discovers the client; until then its answers are lost."""


class Clients:
    """Clients by service and type, the most recently used one last."""

    def __init__(self, node: Node) -> None:
        self._node = node
        self._clients: dict[tuple[str, str], Client] = {}
        self._ready_since_s: dict[Client, float] = {}

    def get(self, service: str, type_name: str, busy: Container[Client]) -> Client:
        """Return the client; may close others that are not `busy`.

        Raises UnknownTypeError, and what rclpy raises for an invalid name.
        """
        key = (service, type_name)
        client = self._clients.pop(key, None)
        if client is None:
            client = self._node.create_client(load_service(type_name), service)
            self._close_some(busy)
            # Its time starts now, although the first request may come later.
            self.is_ready(client)
        self._clients[key] = client
        return client

    def is_ready(self, client: Client) -> bool:
        """Tell whether a request would be received, and its answer too."""
        if not client.service_is_ready():
            self._ready_since_s.pop(client, None)
            return False
        now_s = time.monotonic()
        return now_s - self._ready_since_s.setdefault(client, now_s) >= SETTLE_S

    def _close_some(self, busy: Container[Client]) -> None:
        idle = [key for key, client in self._clients.items() if client not in busy]
        for key in idle[: max(0, len(self._clients) - KEPT)]:
            client = self._clients.pop(key)
            self._ready_since_s.pop(client, None)
            self._node.destroy_client(client)
