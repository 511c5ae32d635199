"""MCP over HTTP on this machine: for agents that are running already. Each one needs the token.

Only 127.0.0.1 is listened on. A web page that a browser has open cannot speak to it either: the SDK
checks Host and Origin, and the token is nowhere in a browser.
"""

from __future__ import annotations

import asyncio
import contextlib
import hmac
import os
import secrets
import socket
import stat
from typing import TYPE_CHECKING

import uvicorn
from mcp.server.transport_security import TransportSecuritySettings
from platformdirs import user_config_path
from starlette.responses import PlainTextResponse

from launcher.errors import UsageError
from launcher.private_files import make_folder, open_file
from text.os_words import os_reason
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from starlette.types import ASGIApp, Receive, Scope, Send

    from agents.server import AgentServer

HOST = "127.0.0.1"
PATH = "/mcp"
MAX_BODY_BYTES = 1 << 20
MAX_SESSIONS = 16
IDLE_S = 1800.0
END_WITHIN_S = 2
BACKLOG = 64
MOST_AT_ONCE = 64
"""Connections; whoever comes then is sent away."""
KEEP_ALIVE_S = 15


def listen(port: int) -> socket.socket:
    """Return a socket on this machine only; port 0 takes a free one.

    Raises:
        UsageError: if the port cannot be had.
    """
    listening = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    try:
        listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listening.bind((HOST, port))
        listening.listen(BACKLOG)
    except OSError as error:
        listening.close()
        words = say(
            "port {port} cannot be listened on: {reason}; choose another with --port",
            port=port,
            reason=os_reason(error),
        )
        raise UsageError(words) from error
    return listening


def address_of(listening: socket.socket) -> str:
    """Return the address that an agent is given."""
    return f"http://{HOST}:{listening.getsockname()[1]}{PATH}"


async def serve_http(server: AgentServer, listening: socket.socket, token: str) -> None:
    """Serve agents until this is cancelled."""
    port = listening.getsockname()[1]
    names = [f"{host}:{port}" for host in (HOST, "localhost")]
    app = server.mcp.streamable_http_app(
        streamable_http_path=PATH,
        max_request_body_size=MAX_BODY_BYTES,
        max_sessions=MAX_SESSIONS,
        session_idle_timeout=IDLE_S,
        transport_security=TransportSecuritySettings(
            allowed_hosts=names, allowed_origins=[f"http://{name}" for name in names]
        ),
        host=HOST,
    )
    config = uvicorn.Config(
        TokenNeeded(app, token),
        log_config=None,
        access_log=False,
        server_header=False,
        timeout_graceful_shutdown=END_WITHIN_S,
        limit_concurrency=MOST_AT_ONCE,
        timeout_keep_alive=KEEP_ALIVE_S,
        ws="none",
        backlog=BACKLOG,
    )
    web = _Web(config)
    async with server.looking():
        serving = asyncio.create_task(web.serve(sockets=[listening]))
        try:
            await asyncio.shield(serving)
        finally:
            web.should_exit = True
            with contextlib.suppress(asyncio.CancelledError):
                await serving


class _Web(uvicorn.Server):
    """Leaves the signals to the command."""

    @contextlib.contextmanager
    def capture_signals(self) -> Iterator[None]:
        yield


class TokenNeeded:
    """Lets only those in who know the token."""

    def __init__(self, app: ASGIApp, token: str) -> None:
        self._app = app
        self._wanted = f"Bearer {token}".encode()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] == "http":
            given = [value for name, value in scope["headers"] if name == b"authorization"]
            if len(given) != 1 or not hmac.compare_digest(given[0], self._wanted):
                refusal = PlainTextResponse(
                    "a bearer token is needed: deck mcp --show-token\n",
                    status_code=401,
                    headers={"WWW-Authenticate": "Bearer"},
                )
                await refusal(scope, receive, send)
                return
        elif scope["type"] != "lifespan":
            return
        await self._app(scope, receive, send)


# ---------------------------------------------------------------- the token: made once, in a file for its owner alone

NAME = "mcp-token"
BYTES = 32
LONGEST = 200


def token_path() -> Path:
    """Return where the token is kept."""
    return user_config_path("deck") / NAME


def own_token() -> str:
    """Return the token, made if there is none yet.

    Raises:
        UsageError: if the file cannot be read or written, or is not private.
    """
    path = token_path()
    try:
        return _read(path)
    except FileNotFoundError:
        pass
    except OSError as error:
        raise _unusable(path, error) from error
    try:
        make_folder(path.parent)
        _make(path)
        return _read(path)
    except OSError as error:
        raise _unusable(path, error) from error


def _make(path: Path) -> None:
    try:
        descriptor = open_file(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL)
    except FileExistsError:
        return  # Another `deck mcp` has just made it.
    with os.fdopen(descriptor, "w", encoding="ascii") as file:
        file.write(secrets.token_urlsafe(BYTES) + "\n")


def _read(path: Path) -> str:
    descriptor = open_file(path, os.O_RDONLY)
    with os.fdopen(descriptor, encoding="ascii", errors="replace") as file:
        found = os.fstat(descriptor)
        if stat.S_IMODE(found.st_mode) & 0o077 or found.st_uid != os.geteuid():
            words = say("{path} can be read by others: remove it, and a new one is made", path=path)
            raise UsageError(words)
        token = file.read(LONGEST).strip()
    if len(token) < BYTES:
        raise UsageError(say("{path} holds no token: remove it, and a new one is made", path=path))
    return token


def _unusable(path: Path, error: OSError) -> UsageError:
    return UsageError(say("{path}: {reason}", path=path, reason=os_reason(error)))
