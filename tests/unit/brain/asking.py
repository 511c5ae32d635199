"""A client of the test's own server."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from brain.budget import Ledger
from brain.client import ModelClient
from brain.key import ServerKey
from brain.settings import ModelSettings
from tests.model_server import KEY

if TYPE_CHECKING:
    from tests.model_server import ModelServer

HELLO = [{"role": "user", "content": "hello"}]


def settings_for(server: ModelServer, **fields: Any) -> ModelSettings:
    """Return settings that name this server."""
    return ModelSettings(base_url=server.url, model="m-1", **fields)


def client_of(server: ModelServer, ledger: Ledger | None = None, **fields: Any) -> ModelClient:
    """Return a client with a key; close it."""
    return ModelClient(settings_for(server, **fields), ServerKey(KEY), ledger or Ledger(), "test")
