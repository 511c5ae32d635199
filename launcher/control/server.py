"""The control socket: receives the clients' requests and sends them events."""

from __future__ import annotations

import asyncio
import os
import re
import socket
import struct
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from launcher.control.agent_requests import AGENT_OPS, serve_agents
from launcher.control.bad_request import BadRequestError
from launcher.control.consent import ConsentDesk, TooManyError, TooSoonError
from launcher.control.feed import ClientFeed
from launcher.control.protocol import (
    MAX_HISTORY_CHARS,
    MAX_HISTORY_LINES,
    MAX_REQUEST_BYTES,
    VERSION,
    encode,
    pack_agents,
    pack_session,
    pack_status,
    pack_stray,
    unpack_stray,
)
from launcher.errors import StillRunningError, UnknownNodeError
from launcher.logs.packing import pack_line
from text.nested import read_json
from text.packing import pack_text
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Callable, Coroutine, Iterable, Mapping, Sequence

    from launcher.logs.ring import LogRing
    from launcher.status import LogLine, NodeStatus, SessionInfo, Severity, Stray

LOG_PERIOD_S = 0.1
STATUS_DELAY_S = 0.01
"""Changes within this time are sent together."""
MAX_UNSENT_BYTES = 1 << 20
"""Unsent bytes beyond which a client is sent nothing more for now."""
STUCK_S = 30.0
"""A client that has read nothing for this long is disconnected."""
MAX_CLIENTS = 64
MAX_SILENT = 128
"""Most connections without a greeting yet; beyond that the oldest are closed.

A client that greets at once is heard before this many others can connect: asyncio accepts 100 at a
time.
"""
GREETED_WITHIN_S = 10.0
MODULE = re.compile(r"nodes\.[a-z][a-z0-9_]*")
"""A node of Deck."""
MAX_REQUESTS = 100
"""Most requests of one client that are served at the same time."""


class Controlled(Protocol):
    """The operations that the supervisor offers to clients."""

    info: SessionInfo
    strays: tuple[Stray, ...]
    unguarded: bool

    def statuses(self) -> Mapping[str, NodeStatus]:
        """Return the current status of every node."""

    def rings(self) -> Mapping[str, LogRing]:
        """Return every node's log."""

    def history(self, node: str | None, limit: int) -> Sequence[LogLine]:
        """Return the newest lines of one node or of all."""

    def start(self, names: Iterable[str]) -> None:
        """Start nodes; raises `UnknownNodeError`."""

    async def stop(self, names: Iterable[str], *, now: bool) -> None:
        """Stop nodes; raises `UnknownNodeError`, and `StillRunningError` if they do not end."""

    def restart(self, names: Iterable[str]) -> None:
        """Restart nodes; raises `UnknownNodeError`."""

    def exchange(self, name: str, program: str | None) -> None:
        """Run this file or module in the place of a node's program, or again that itself (None).

        Raises `UnknownNodeError`.
        """

    async def stop_strays(self, strays: Iterable[Stray]) -> None:
        """End these processes that an earlier run left behind."""

    def tell_of_agents(self, severity: Severity, words: str) -> None:
        """Add a line about an agent to the log."""

    async def emergency_stop(self, said_ns: int) -> str:
        """Give an emergency stop, known by that time; return why it could not be."""

    async def emergency_release(self, said_ns: int) -> str:
        """Release the emergency stops from before that time; return why they could not be."""

    def shut_down(self, asked_by: int, *, now: bool) -> None:
        """Begin to stop all nodes and then the supervisor, on behalf of process `asked_by`."""


class ControlServer:
    """Serves every client of one session."""

    def __init__(self, controlled: Controlled) -> None:
        self._controlled = controlled
        self.consent = ConsentDesk(self._agents_changed, controlled.tell_of_agents)
        self._clients: dict[_Client, None] = {}
        """In the order in which they connected."""
        self._server: asyncio.AbstractServer | None = None
        self._loop = asyncio.get_running_loop()
        self._status_timer: asyncio.TimerHandle | None = None
        self._log_timer: asyncio.TimerHandle | None = None
        self._last_log = float("-inf")

    async def serve(self, listening: socket.socket) -> None:
        """Accept clients on this socket only from now on; existing connections stay."""
        if self._server is not None:
            self._server.close()
        self._server = await asyncio.start_unix_server(self._welcome, sock=listening, limit=MAX_REQUEST_BYTES)

    def status_changed(self, name: str) -> None:
        """Note that a node's status has changed."""
        for client in self._clients:
            client.feed.status_changed([name])
        if self._status_timer is None and self._clients:
            self._status_timer = self._loop.call_later(STATUS_DELAY_S, self._tell_statuses)

    def lines_came(self) -> None:
        """Note that there are new log lines."""
        if self._log_timer is None and self._clients:
            wait = max(self._last_log + LOG_PERIOD_S - self._loop.time(), STATUS_DELAY_S)
            self._log_timer = self._loop.call_later(wait, self._tell_lines)

    def strays_changed(self) -> None:
        news = {"event": "strays", "strays": [pack_stray(one) for one in self._controlled.strays]}
        for client in self._clients:
            client.tell(news)

    def guardian_lost(self) -> None:
        for client in self._clients:
            client.tell({"event": "unguarded"})

    def _agents_changed(self) -> None:
        news = {"event": "agents", "agents": pack_agents(self.consent.state)}
        for client in self._clients:
            client.tell(news)

    async def close(self, reason: str) -> None:
        """Tell every client how the session ended, and disconnect."""
        if self._server is not None:
            self._server.close()
        self.consent.end_all()
        self._tell_statuses()
        self._tell_lines()
        for client in tuple(self._clients):
            client.tell({"event": "closed", "reason": pack_text(reason)})
            client.writer.close()
        pending = [client.task for client in self._clients if client.task is not None]
        if pending:
            await asyncio.wait(pending, timeout=1.0)

    def _tell_statuses(self) -> None:
        self._status_timer = None
        statuses = self._controlled.statuses()
        for client in self._clients:
            if client.takes_more():
                client.tell(client.feed.status_news(statuses))

    def _tell_lines(self) -> None:
        self._log_timer = None
        self._last_log = self._loop.time()
        behind = False
        for client in tuple(self._clients):
            if client.takes_more():
                client.tell(client.feed.status_news(self._controlled.statuses()))
                client.tell(client.feed.log_news())
            else:
                behind = True
        if behind:
            self._log_timer = self._loop.call_later(LOG_PERIOD_S, self._tell_lines)

    async def _welcome(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        pid, uid = _peer(writer)
        # What a learner's file does in a grading is not what its teacher asks for.
        strange = uid != os.getuid() or _is_elsewhere(pid)
        if strange or not self._has_room():
            writer.close()
            return
        client = _Client(writer, ClientFeed(self._controlled.rings()))
        client.task = asyncio.current_task()
        client.pid = pid
        client.tell(
            {
                "deck": VERSION,
                "session": pack_session(self._controlled.info),
                "nodes": [pack_status(one) for one in self._controlled.statuses().values()],
                "strays": [pack_stray(one) for one in self._controlled.strays],
                "agents": pack_agents(self.consent.state),
                "unguarded": self._controlled.unguarded,
            }
        )
        self._clients[client] = None
        try:
            await self._converse(client, reader)
        except ConnectionError:
            pass
        finally:
            self._clients.pop(client, None)
            self.consent.leave(client)
            writer.close()

    def _has_room(self) -> bool:
        """Whether one more client may connect; connections without a greeting make way."""
        silent = [client for client in self._clients if not client.greeted]
        if len(self._clients) - len(silent) >= MAX_CLIENTS:
            return False
        for client in silent[: max(len(silent) - MAX_SILENT + 1, 0)]:
            del self._clients[client]
            client.writer.transport.abort()
        return True

    async def _converse(self, client: _Client, reader: asyncio.StreamReader) -> None:
        while True:
            try:
                within_s = None if client.greeted else GREETED_WITHIN_S
                line = await asyncio.wait_for(reader.readline(), within_s)
            except asyncio.TimeoutError:
                return
            except ValueError:
                client.refuse(None, "too_long", say("a request of more than 1 MiB"))
                return
            if not line:
                return
            try:
                request = _read(line)
                if client.greeted:
                    client.begin(self._serve(client, request))
                else:
                    _check_version(request)
                    client.greeted = True
            except BadRequestError as error:
                client.refuse(None, "bad_request", str(error))
                if not client.greeted:
                    return
            # A client that does not read its answers need not send more requests.
            await client.writer.drain()

    async def _serve(self, client: _Client, request: dict[str, Any]) -> None:
        request_id = request.get("id")
        try:
            result = await self._answer(request, client)
        except UnknownNodeError as error:
            client.refuse(request_id, "unknown_node", str(error), name=error.name, known=error.known)
        except StillRunningError as error:
            client.refuse(request_id, "still_running", pack_text(error.args[0]))
        except BadRequestError as error:
            client.refuse(request_id, "bad_request", str(error))
        except TooSoonError as error:
            words = say(
                "the person has just refused: nothing is asked for another {seconds:.0f} s",
                seconds=max(error.wait_s, 1.0),
            )
            client.refuse(request_id, "too_soon", words)
        except TooManyError:
            client.refuse(request_id, "too_many", say("too many agents ask at once"))
        except Exception as error:
            # A bug of ours, traced in the supervisor's log; the client must not wait for ever.
            client.refuse(request_id, "fault", f"{type(error).__name__}: {error}")
            raise
        else:
            # A client that reads the reply must already have the resulting status.
            client.tell(client.feed.status_news(self._controlled.statuses()))
            client.tell({"reply": request_id, "result": result})

    async def _answer(self, request: dict[str, Any], client: _Client) -> object:
        op = request.get("op")
        if isinstance(op, str) and op in AGENT_OPS:
            tell = self._controlled.tell_of_agents
            return await serve_agents(self.consent, client, request, tell)
        return await self._serve_nodes(request, client.pid)

    async def _serve_nodes(self, request: dict[str, Any], asked_by: int) -> object:
        controlled = self._controlled
        op = request.get("op")
        if op == "start":
            controlled.start(_names(request))
        elif op == "restart":
            controlled.restart(_names(request))
        elif op == "stop":
            await controlled.stop(_names(request), now=request.get("now") is True)
        elif op == "exchange":
            controlled.exchange(*_exchange(request))
        elif op == "history":
            return self._history(request)
        elif op == "emergency_stop":
            _check(await controlled.emergency_stop(_said_ns(request)))
        elif op == "emergency_release":
            _check(await controlled.emergency_release(_said_ns(request)))
        elif op == "stop_strays":
            await controlled.stop_strays(_strays(request))
        elif op == "shutdown":
            controlled.shut_down(asked_by, now=request.get("now") is True)
        else:
            raise BadRequestError(say("unknown request {op!r}", op=op))
        return None

    def _history(self, request: dict[str, Any]) -> list[Any]:
        node, limit = request.get("node"), request.get("limit")
        if not isinstance(node, (str, type(None))):
            raise BadRequestError(say("node: expected a name, found {x!r}", x=node))
        if node is not None and node not in self._controlled.rings():
            raise UnknownNodeError(node, self._controlled.statuses())
        if not isinstance(limit, int) or limit < 0:
            raise BadRequestError(say("limit: expected a whole number, found {x!r}", x=limit))
        lines = self._controlled.history(node, min(limit, MAX_HISTORY_LINES))
        return [pack_line(line) for line in _newest(lines, MAX_HISTORY_CHARS)]


class _Client:
    """One connection."""

    def __init__(
        self, writer: asyncio.StreamWriter, feed: ClientFeed, now: Callable[[], float] = time.monotonic
    ) -> None:
        self.writer = writer
        self.feed = feed
        self.task: asyncio.Task[Any] | None = None
        self.pid = 0
        """The client's process number."""
        self.greeted = False
        self._requests: set[asyncio.Task[None]] = set()
        self._now = now
        self._behind_since: float | None = None

    def begin(self, serving: Coroutine[Any, Any, None]) -> None:
        """Serve a request alongside the others: stopping a node takes time."""
        if len(self._requests) >= MAX_REQUESTS:
            serving.close()
            raise BadRequestError(say("too many requests at once"))
        task = asyncio.create_task(serving)
        self._requests.add(task)
        task.add_done_callback(self._requests.discard)

    def takes_more(self) -> bool:
        """Whether to send it more now; disconnects it if it has been stuck for too long."""
        if self.writer.transport.get_write_buffer_size() < MAX_UNSENT_BYTES:
            self._behind_since = None
            return True
        now = self._now()
        if self._behind_since is None:
            self._behind_since = now
        elif now - self._behind_since > STUCK_S:
            self.writer.transport.abort()
        return False

    def tell(self, message: dict[str, Any] | None) -> None:
        if message is not None and not self.writer.is_closing():
            self.writer.write(encode(message))

    def refuse(self, request_id: object, kind: str, message: str, **more: object) -> None:
        """Reply that a request was not served, and why."""
        error = {"kind": kind, "message": message, **more}
        self.tell({"reply": request_id, "error": error})


def _peer(writer: asyncio.StreamWriter) -> tuple[int, int]:
    """Return the process and user at the other end of a connection."""
    credentials = struct.Struct("3i")
    connection = writer.get_extra_info("socket")
    packed = connection.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, credentials.size)
    pid, uid, _gid = credentials.unpack(packed)
    return pid, uid


def _is_elsewhere(pid: int) -> bool:
    """Whether a process is in another user or process namespace, or cannot be looked at."""
    try:
        return any(
            Path(f"/proc/{pid}/ns/{kind}").readlink() != Path(f"/proc/self/ns/{kind}").readlink()
            for kind in ("user", "pid")
        )
    except OSError:
        return True


def _read(line: bytes) -> dict[str, Any]:
    try:
        request = read_json(line)
    except ValueError:
        raise BadRequestError(say("not a line of JSON")) from None
    if not isinstance(request, dict):
        raise BadRequestError(say("expected a JSON object"))
    return request


def _check_version(request: dict[str, Any]) -> None:
    version = request.get("deck")
    if version != VERSION:
        raise BadRequestError(
            say("this supervisor speaks version {ours}, not {theirs}", ours=VERSION, theirs=version)
        )


def _said_ns(request: dict[str, Any]) -> int:
    said_ns = request.get("said_ns", time.time_ns())
    if not isinstance(said_ns, int) or not 0 < said_ns < 1 << 62:
        raise BadRequestError(say("said_ns: expected a time, found {x!r}", x=said_ns))
    return said_ns


def _check(problem: str) -> None:
    if problem:
        raise BadRequestError(say("the emergency stop on disk cannot be changed: {problem}", problem=problem))


def _newest(lines: Sequence[LogLine], max_chars: int) -> Sequence[LogLine]:
    for position in range(len(lines) - 1, -1, -1):
        max_chars -= len(lines[position].text)
        if max_chars < 0:
            return lines[position + 1 :]
    return lines


def _names(request: dict[str, Any]) -> list[str]:
    names = request.get("nodes", [])
    if not isinstance(names, list) or not all(isinstance(name, str) for name in names):
        raise BadRequestError(say("nodes: expected a list of names"))
    return names


def _exchange(request: dict[str, Any]) -> tuple[str, str | None]:
    node, program = request.get("node"), request.get("run")
    if not isinstance(node, str):
        raise BadRequestError(say("node: expected a name, found {x!r}", x=node))
    if program is None:
        return node, None
    if not isinstance(program, str) or not (os.path.isabs(program) or MODULE.fullmatch(program)):  # noqa: PTH117
        words = say("run: expected an absolute path or a module, found {x!r}", x=program)
        raise BadRequestError(words)
    return node, program


def _strays(request: dict[str, Any]) -> list[Stray]:
    try:
        return [unpack_stray(fields) for fields in request["strays"]]
    except (TypeError, ValueError, KeyError):
        raise BadRequestError(say("strays: expected a list of strays")) from None
