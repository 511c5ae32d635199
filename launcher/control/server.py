"""The control socket: receives the clients' requests and sends them events."""

from __future__ import annotations

import asyncio
import heapq
import os
import socket
import struct
import time
from collections.abc import Callable, Coroutine, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from launcher.control.consent import ConsentDesk
from launcher.control.requests import BadRequestError, requests_of, serve
from launcher.errors import StillRunningError, UnknownNodeError
from launcher.events import (
    AgentsEvent,
    ClosedEvent,
    Event,
    Hello,
    LogEvent,
    StatusEvent,
    StraysEvent,
    UnguardedEvent,
    pack_event,
)
from launcher.logs.ring import LogRing
from launcher.status import NodeStatus, Severity, Stray
from launcher.wire import MAX_REQUEST_BYTES, VERSION, encode, pack
from text.nested import read_json
from text.packing import pack_text
from text.sentences import say

MAX_LINES = 200
"""Most lines of one node in one batch."""
MAX_CHARS = 64 * 1024
"""Most characters of one node's lines in one batch, not counting its first line."""


LOG_PERIOD_S = 0.1
STATUS_DELAY_S = 0.01
"""Changes within this time are sent together."""
MAX_UNSENT_BYTES = 1 << 20
"""Unsent bytes beyond which a client is sent nothing more for now."""
STUCK_S = 30.0
"""A client that has read nothing for this long is disconnected."""
MAX_CLIENTS = 64
GREETED_WITHIN_S = 10.0
"""A connection that says nothing makes room for others after this time."""
MAX_REQUESTS = 100


class ControlServer:
    """Serves every client of one session."""

    def __init__(
        self,
        hello: Callable[[], Hello],
        rings: Callable[[], Mapping[str, LogRing]],
        tell_of_agents: Callable[[Severity, str], None],
    ) -> None:
        """`hello` says how everything is, `rings` has every node's log.

        `tell_of_agents` adds a line about an agent to the log.
        """
        self._hello, self._rings = hello, rings
        self.consent = ConsentDesk(self._agents_changed, tell_of_agents)
        self._requests = requests_of(self.consent)
        self._clients: dict[Client, None] = {}
        """In the order in which they connected."""
        self._server: asyncio.AbstractServer | None = None
        self._loop = asyncio.get_running_loop()
        self._status_timer: asyncio.TimerHandle | None = None
        self._log_timer: asyncio.TimerHandle | None = None
        self._last_log = float("-inf")

    def take_requests_for(self, *servers: object) -> None:
        """Let these serve requests, too, see `requests_of`."""
        self._requests |= requests_of(*servers)

    async def serve(self, listening: socket.socket) -> None:
        """Accept clients on this socket only from now on; existing connections stay."""
        if self._server is not None:
            self._server.close()
        self._server = await asyncio.start_unix_server(self._welcome, sock=listening, limit=MAX_REQUEST_BYTES)

    def status_changed(self, name: str) -> None:
        """Note that a node's status has changed."""
        for client in self._clients:
            client.changed[name] = None
        if self._status_timer is None and self._clients:
            self._status_timer = self._loop.call_later(STATUS_DELAY_S, self._tell_statuses)

    def lines_came(self) -> None:
        """Note that there are new log lines."""
        if self._log_timer is None and self._clients:
            wait = max(self._last_log + LOG_PERIOD_S - self._loop.time(), STATUS_DELAY_S)
            self._log_timer = self._loop.call_later(wait, self._tell_lines)

    def strays_changed(self, strays: tuple[Stray, ...]) -> None:
        self._tell_all(StraysEvent(strays))

    def guardian_lost(self) -> None:
        self._tell_all(UnguardedEvent())

    def _agents_changed(self) -> None:
        self._tell_all(AgentsEvent(self.consent.state))

    def _tell_all(self, event: Event) -> None:
        news = pack_event(event)
        for client in self._clients:
            client.tell(news)

    def _statuses(self) -> Mapping[str, NodeStatus]:
        return {status.name: status for status in self._hello().nodes}

    async def close(self, reason: str) -> None:
        """Tell every client how the session ended, and disconnect."""
        if self._server is not None:
            self._server.close()
        self.consent.end_consent()
        self._tell_statuses()
        self._tell_lines()
        for client in tuple(self._clients):
            client.tell(pack_event(ClosedEvent(reason)))
            client.writer.close()
        pending = [client.task for client in self._clients if client.task is not None]
        if pending:
            await asyncio.wait(pending, timeout=1.0)

    def _tell_statuses(self) -> None:
        self._status_timer = None
        for client in self._clients:
            if client.takes_more():
                client.tell(client.status_news(self._statuses))

    def _tell_lines(self) -> None:
        self._log_timer = None
        self._last_log = self._loop.time()
        behind = False
        for client in tuple(self._clients):
            if client.takes_more():
                client.tell(client.status_news(self._statuses))
                client.tell(client.log_news())
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
        client = Client(writer, self._rings())
        client.task = asyncio.current_task()
        client.pid = pid
        client.tell(pack(replace(self._hello(), agents=self.consent.state)))
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
        """Whether one more client may connect: the first that has said nothing yet makes way."""
        if len(self._clients) < MAX_CLIENTS:
            return True
        silent = next((client for client in self._clients if not client.greeted), None)
        if silent is None:
            return False
        del self._clients[silent]
        silent.writer.transport.abort()
        return True

    async def _converse(self, client: Client, reader: asyncio.StreamReader) -> None:
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

    async def _serve(self, client: Client, request: dict[str, Any]) -> None:
        request_id = request.get("id")
        try:
            result = await serve(self._requests, client, request)
        except UnknownNodeError as error:
            client.refuse(request_id, "unknown_node", str(error), name=error.name, known=error.known)
        except StillRunningError as error:
            client.refuse(request_id, "still_running", pack_text(error.args[0]))
        except BadRequestError as error:
            client.refuse(request_id, error.kind, str(error))
        except Exception as error:
            # A bug of ours, traced in the supervisor's log; the client must not wait for ever.
            client.refuse(request_id, "fault", f"{type(error).__name__}: {error}")
            raise
        else:
            # A client that reads the reply must already have the resulting status.
            client.tell(client.status_news(self._statuses))
            client.tell({"reply": request_id, "result": pack(result)})


class Client:
    """One connection."""

    def __init__(
        self, writer: asyncio.StreamWriter, rings: Mapping[str, LogRing], now: Callable[[], float] = time.monotonic
    ) -> None:
        """Begin with lines that are written from now on; older ones are history."""
        self.writer = writer
        self.changed: dict[str, None] = {}
        """The nodes whose statuses are to be sent."""
        self._rings = rings
        self._seen = {name: ring.last_seq for name, ring in rings.items()}
        self.task: asyncio.Task[Any] | None = None
        self.pid = 0
        """The client's process number."""
        self.greeted = False
        self._requests: set[asyncio.Task[None]] = set()
        self._now = now
        self._behind_since: float | None = None

    def status_news(self, statuses: Callable[[], Mapping[str, NodeStatus]]) -> dict[str, Any] | None:
        """Return the message about changed nodes, None if there are none."""
        if not self.changed:
            return None
        now = statuses()
        nodes = tuple(now[name] for name in self.changed)
        self.changed.clear()
        return pack_event(StatusEvent(nodes))

    def log_news(self) -> dict[str, Any] | None:
        """Return the next batch of lines, None if there are none."""
        news = []
        skipped = {}
        for name, ring in self._rings.items():
            missed = ring.last_seq - self._seen[name]
            if missed:
                lines = ring.after(self._seen[name], MAX_LINES, MAX_CHARS)
                self._seen[name] = ring.last_seq
                news.append(lines)
                if missed > len(lines):
                    skipped[name] = missed - len(lines)
        if not news:
            return None
        # A node's own lines always stay in order, whatever their time stamps say.
        batch = heapq.merge(*news, key=lambda line: line.time_s)
        return pack_event(LogEvent(tuple(batch), skipped))

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
