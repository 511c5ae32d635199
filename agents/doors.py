"""Connections to the server by HTTP: a request comes whole and soon, or its connection ends.

Whoever has not shown the token keeps no connection from an agent that has: such connections are
few, and the oldest makes way. So no process of this machine can use up the descriptors, or the
patience, of the server that an agent would say stop to.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import h11
from uvicorn.protocols.http.h11_impl import H11Protocol

if TYPE_CHECKING:
    import asyncio

WHOLE_WITHIN_S = 15.0
"""From the first byte of a request, or from the connection, to the request's last byte."""
MOST_STRANGERS = 64
"""Most connections at once that have not shown the token."""
BACKLOG = 64
"""Connections that are accepted in one go, before any of them can be closed again."""
CONNECTION = "deck.connection"
"""Under this name a request's state has its connection."""


class GuardedConnection(H11Protocol):
    """One connection; uvicorn makes it."""

    _strangers: dict[GuardedConnection, None] = {}  # noqa: RUF012 - one server a process
    """Those that have not shown the token, oldest first."""

    def __init__(self, config: Any, server_state: Any, app_state: Any, _loop: Any = None) -> None:  # noqa: ANN401 - uvicorn's own
        super().__init__(config, server_state, {**app_state, CONNECTION: self}, _loop)
        self._late: asyncio.TimerHandle | None = None

    def shows_token(self) -> None:
        """Note that it belongs to an agent that may be here."""
        self._strangers.pop(self, None)

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Let it in; the stranger that has been here longest makes way."""
        super().connection_made(transport)
        self._strangers[self] = None
        if len(self._strangers) > MOST_STRANGERS:
            next(iter(self._strangers)).end()
        self._expect_request()

    def connection_lost(self, exc: Exception | None) -> None:
        self.shows_token()
        self._expect_nothing()
        super().connection_lost(exc)

    def data_received(self, data: bytes) -> None:
        """Take bytes; those of a request that is not whole yet do not buy more time."""
        super().data_received(data)
        if self.conn.their_state in (h11.IDLE, h11.SEND_BODY):
            self._expect_request()
        else:
            self._expect_nothing()

    def end(self) -> None:
        self.shows_token()
        self.transport.abort()

    def _expect_request(self) -> None:
        if self._late is None:
            self._late = self.loop.call_later(WHOLE_WITHIN_S, self.end)

    def _expect_nothing(self) -> None:
        if self._late is not None:
            self._late.cancel()
            self._late = None
