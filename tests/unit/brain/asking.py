"""A client of the test's own server."""

from __future__ import annotations

from typing import Any

from brain.budget import Ledger
from brain.client import ModelClient
from brain.key import ServerKey
from brain.settings import ModelSettings
from tests.model_server import KEY, ModelServer

HELLO = [{"role": "user", "content": "hello"}]


def settings_for(server: ModelServer, **fields: Any) -> ModelSettings:
    return ModelSettings(base_url=server.url, model="m-1", **fields)


def client_of(server: ModelServer, ledger: Ledger | None = None, **fields: Any) -> ModelClient:
    return ModelClient(settings_for(server, **fields), ServerKey(KEY), ledger or Ledger(), "test")
