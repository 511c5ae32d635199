"""The client side of the launcher: start a profile, attach to a session, control and follow it."""

from __future__ import annotations

import asyncio
import contextlib
import os
import time
from collections.abc import AsyncIterator, Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from launcher.client.inbox import Inbox, newer
from launcher.client.running import find_running, kill_supervisor, left_behind, left_of, running_records
from launcher.client.start import StartingSupervisor
from launcher.client.stop_road import StopRoad
from launcher.consent import Agents, Approval, ConsentAnswer, ConsentVerdict
from launcher.control.socket import connect
from launcher.errors import (
    ConnectionLostError,
    ProtocolError,
    SilentSupervisorError,
    StillRunningError,
    UnknownNodeError,
    UsageError,
)
from launcher.events import (
    AgentsEvent,
    ClosedEvent,
    Event,
    Hello,
    LogEvent,
    StatusEvent,
    StraysEvent,
    UnguardedEvent,
    unpack_event,
)
from launcher.processes.table import Process, read_process
from launcher.run_id import supervisor_of
from launcher.rundir import log_dir, run_dir
from launcher.serial_ports import serial_ports
from launcher.status import LogLine, NodeStatus, SessionInfo, Severity, Stray
from launcher.supervisor.words import who
from launcher.wire import MAX_MESSAGE_BYTES, VERSION, encode, pack, unpack
from text.nested import read_json
from text.packing import pack_text, unpack_text
from text.sentences import Words, say

if TYPE_CHECKING:
    from launcher.profile.load import Profile

HELLO_WITHIN_S = 10.0
SUSPENDED_S, LOOK_S = 1.0, 0.1
"""One that has been suspended for so long need not be waited for; how often that is looked at."""
HEARD_WITHIN_S = 30.0
"""A supervisor that has not acknowledged a shutdown request after this time has hung."""
HEARD_IN_A_HURRY_S = 5.0
ENDED_IN_A_HURRY_S = 20.0
"""The supervisor's own time limits, plus the time it takes to close its connections."""
STOPPED_WITHIN_S = 20.0
"""The same for nodes that do not need each other: its limits for SIGINT, SIGTERM and SIGKILL."""
UNSENT_WITHIN_S = 1.0
GONE = say("the supervisor is gone")
"""Why a session has ended whose supervisor did not say it."""


async def launch(
    profile: Path | str | Profile,
    *,
    hardware: str = "mock",
    overrides: Iterable[str] = (),
    domain: int | None = None,
    foreground: bool = True,
    node_lang: str = "",
    supervisor: StartingSupervisor | None = None,
    within: Iterable[str] = (),
) -> SupervisorClient:
    """Start a profile and connect to its supervisor.

    Args:
        profile: its file, or a profile already loaded (then the next three are ignored)
        hardware: `mock` or `real`
        overrides: `node.param=value`
        domain: the ROS domain, overriding the profile and the environment
        foreground: whether the nodes end with this process, or with `aclose`
        node_lang: the language the nodes log in, `en` or `ru`; empty: as the environment says
        supervisor: one that was started in advance, for this call only
        within: the beginning of a command line that confines a program, for nodes other than Deck's

    Raises:
        ProfileError, DomainError: if the profile or domain cannot be used; nothing was started.
        AlreadyRunningError: if one of its nodes is already running in that domain.
        RunDirError: if there is no usable directory for sockets or logs.
        StartError: if the supervisor did not start.
    """
    supervisor = supervisor or StartingSupervisor()
    try:
        from launcher.supervisor.plan import plan_of  # With pydantic, for which others need not wait.

        folders = {"run_dir": str(run_dir()), "log_dir": str(log_dir())}
        read = await asyncio.to_thread(_read, profile, hardware, tuple(overrides), domain)
        plan = plan_of(read, **folders, foreground=foreground, node_lang=node_lang, within=within)
    except BaseException:
        supervisor.give_up()
        raise
    folder, lifeline = await supervisor.begin(plan)
    if not foreground:
        os.close(lifeline)
        lifeline = -1
    try:
        return await _connect(folder, lifeline)
    except BaseException as problem:
        if lifeline >= 0:
            os.close(lifeline)
            if isinstance(problem, SilentSupervisorError):
                raise SilentSupervisorError(await kill_supervisor(folder.name)) from None
        raise


async def attach(name: str | None = None) -> SupervisorClient:
    """Connect to a running session: the only one, or the one that `find_running` finds.

    Raises:
        NotRunningError: if there is none.
        SeveralRunningError: if there are several to choose from.
        ConnectionLostError: if it has just ended.
        SilentSupervisorError: if it does not respond.
        ProtocolError: if it speaks another version of the protocol.
    """
    record = await asyncio.to_thread(find_running, name)
    return await _connect(record.folder)


def running() -> list[SessionInfo]:
    """Return all running sessions, oldest first."""
    return [record.session for record in running_records()]


def _read(profile: Path | str | Profile, hardware: str, overrides: tuple[str, ...], domain: int | None) -> Profile:
    from launcher.profile.load import Profile, load_profile

    if isinstance(profile, Profile):
        return profile
    return load_profile(profile, hardware=hardware, overrides=overrides, domain=domain, ports=serial_ports)


def _own_file(file: Path) -> str:
    if not file.is_file():
        raise UsageError(say("there is no file {path}", path=str(file)))
    return str(file.absolute())


def _silent(pid: int) -> Words:
    return say("the supervisor (pid {pid}) does not answer; kill -9 {pid} ends it", pid=pid)


def _endless(pid: int, left: Sequence[Process]) -> Words:
    return say(
        "the supervisor (pid {pid}) has heard it and does not end; still running: {who}; kill -9 {pid} ends it",
        pid=pid,
        who=who(left),
    )


async def _connect(folder: Path, lifeline: int = -1) -> SupervisorClient:
    try:
        connection = await asyncio.to_thread(connect, folder)
        reader, writer = await asyncio.open_unix_connection(sock=connection, limit=MAX_MESSAGE_BYTES)
    except asyncio.TimeoutError as problem:
        raise SilentSupervisorError(_silent(supervisor_of(folder.name))) from problem
    except OSError as problem:
        raise ConnectionLostError(say("the supervisor does not answer")) from problem
    try:
        hello = await _greeted(reader, writer, folder)
    except BaseException:
        writer.close()
        raise
    return SupervisorClient(hello, reader, writer, lifeline, folder)


async def _first_line(reader: asyncio.StreamReader, supervisor: int) -> bytes:
    """Return what the supervisor says first.

    Raises:
        asyncio.TimeoutError: if it says nothing in time, or has been suspended for a while.
    """
    reading = asyncio.ensure_future(reader.readline())
    began_s = runs_s = time.monotonic()
    try:
        while not (await asyncio.wait({reading}, timeout=LOOK_S))[0]:
            now_s = time.monotonic()
            process = read_process(supervisor)
            if process is None or not process.suspended:
                runs_s = now_s
            if now_s - runs_s > SUSPENDED_S or now_s - began_s > HELLO_WITHIN_S:
                raise asyncio.TimeoutError
        return reading.result()
    finally:
        reading.cancel()


async def _greeted(reader: asyncio.StreamReader, writer: asyncio.StreamWriter, folder: Path) -> Hello:
    """Announce our protocol version; return the greeting of a supervisor with the same version."""
    try:
        writer.write(encode({"deck": VERSION}))
        said: dict[str, Any] = read_json(await _first_line(reader, supervisor_of(folder.name)))
        if said.get("deck") == VERSION:
            hello: Hello = unpack(Hello, said)
            return hello
    except asyncio.TimeoutError as problem:
        raise SilentSupervisorError(_silent(supervisor_of(folder.name))) from problem
    except (OSError, ValueError) as problem:
        raise ConnectionLostError(say("the supervisor does not answer")) from problem
    raise ProtocolError(
        say(
            "the running session belongs to another version of Deck ({theirs}, this "
            "is {ours}); use that version to stop it",
            theirs=said.get("deck"),
            ours=VERSION,
        )
    )


class SupervisorClient:
    """A connection to a supervisor; made by `launch` and `attach`."""

    def __init__(
        self, hello: Hello, reader: asyncio.StreamReader, writer: asyncio.StreamWriter, lifeline: int, folder: Path
    ) -> None:
        """`lifeline` is a descriptor that keeps a foreground session alive, or -1.

        `folder` has the session's socket.
        """
        self.session = hello.session
        self.own = lifeline >= 0
        """Whether this client started the session, in the foreground: it ends with this client."""
        self.nodes: dict[str, NodeStatus] = {}
        """All nodes in the profile's order, kept up to date."""
        self.strays: tuple[Stray, ...] = ()
        """Processes that an earlier run left behind, kept up to date."""
        self.agents = Agents()
        """The agents, and what they ask for, kept up to date."""
        self.unguarded = hello.unguarded
        """Whether the supervisor has lost its guardian, kept up to date."""
        self.emergency_stop = StopRoad(folder, self.session.domain)
        """Gives (True) or releases (False) the emergency stop without the middleware, on any thread
        and without waiting."""
        self._reader = reader
        self._writer = writer
        self._lifeline = lifeline
        self._inbox = Inbox()
        self._replies: dict[int, asyncio.Future[Any]] = {}
        self._next_id = 1
        self._closed = asyncio.Event()
        self._parting: asyncio.Task[Words] | None = None
        for event in (StatusEvent(hello.nodes), StraysEvent(hello.strays), AgentsEvent(hello.agents)):
            self._take(event)
        self._listening = asyncio.create_task(self._listen())

    async def events(self, *, past: int = 0) -> AsyncIterator[Event]:
        """Yield events, `ClosedEvent` last; for a single consumer.

        The first events are the newest `past` lines of the log so far, and the statuses at the time
        of connecting. Events that are not consumed are merged: there is never a backlog of more
        than one event of each kind.
        """
        known: dict[str, int] = {}
        if past:
            # Without them, it still has to be heard that the session ends.
            with contextlib.suppress(ConnectionLostError, ProtocolError):
                lines = await self.history(None, past)
                known = {line.node: line.seq for line in lines}
                yield LogEvent(tuple(lines))
        async for event in self._inbox.events():
            if isinstance(event, LogEvent):
                event = newer(event, known)  # noqa: PLW2901
                if not event.lines and not event.skipped:
                    continue
            yield event

    async def start(self, *names: str) -> None:
        """Start these nodes and everything they need; all nodes if none is named.

        A node that is waiting for others, or for its next attempt, starts at once.
        """
        await self._ask("start", nodes=names)

    async def stop(self, *names: str, now: bool = False) -> None:
        """Stop these nodes, dependants first; all if none is named. Return when they have ended.

        `now`, or a second call, skips the waits between the signals.

        Raises:
            StillRunningError: if some of their processes have not ended by SIGKILL.
        """
        await self._ask("stop", nodes=names, now=now)

    async def restart(self, *names: str) -> None:
        """Begin to restart these nodes; all if none is named."""
        await self._ask("restart", nodes=names)

    async def exchange(self, name: str, program: Path | str | None) -> None:
        """Run another program in the place of a node's own; None: that of the profile again.

        It is a file of the learner's, or a module of Deck, such as `nodes.mock_sonar`.

        A node that runs is restarted; one that was stopped stays stopped. `NodeStatus.file` tells
        which it is. A file that does not compile leaves the old process running, see
        `NodeStatus.fault`.

        Raises:
            UsageError: if there is no such file.
            UnknownNodeError: if there is no such node.
        """
        if isinstance(program, Path):
            program = await asyncio.to_thread(_own_file, program)
        await self._ask("exchange", node=name, run=program)

    async def history(self, node: str | None, limit: int) -> list[LogLine]:
        """Return the newest lines, oldest first, of one node, or of all nodes in order of time."""
        lines = await self._ask("history", node=node, limit=limit)
        return [LogLine.unpacked(line) for line in lines]

    async def stop_strays(self, strays: Iterable[Stray]) -> None:
        """End these processes of an earlier run; return when they have ended."""
        await self._ask("stop_strays", strays=[pack(stray) for stray in strays])

    async def attend(self) -> None:
        """Say that a person at this screen can answer the questions of agents."""
        await self._ask("attend")

    async def answer(self, question: int, answer: ConsentAnswer) -> bool:
        """Answer a question; return False if it is no longer asked."""
        answered: bool = await self._ask("answer", question=question, answer=answer.value)
        return answered

    async def end_consent(self) -> None:
        """End every question, and every allowance for a time."""
        await self._ask("end_consent")

    async def join(self, key: str, name: str, approval: Approval) -> None:
        """Say that an agent is connected; `key` distinguishes those of this client."""
        await self._ask("join", key=key, name=name, approval=approval.value)

    async def ask_consent(self, key: str, lines: Iterable[str], *, anew: bool = False) -> ConsentVerdict:
        """Ask the person at the screen whether an agent may do this; takes a while.

        `anew`: also if they have allowed it for a time.
        """
        packed = [pack_text(line) for line in lines]
        return ConsentVerdict(await self._ask("ask", key=key, lines=packed, anew=anew))

    async def withdraw(self, key: str | None = None) -> None:
        """Withdraw the questions of one agent, or of all agents of this client."""
        await self._ask("withdraw", key=key)

    async def tell(self, severity: Severity, words: str) -> None:
        """Add a line about an agent to the log."""
        await self._ask("tell", severity=severity.value, words=pack_text(words))

    async def shutdown(self, now: bool = False) -> None:
        """Stop all nodes, dependants first, then the supervisor; return when it has ended.

        `now`, or a second call, skips the waits, including those of a call in progress.

        Raises:
            SilentSupervisorError: if it does not respond, or does not end. If this client started
                it, it and its nodes have then been killed.
            StillRunningError: if it has ended, and processes of its nodes have not.
        """
        if self._closed.is_set():
            await self.aclose()
            return
        from launcher.supervisor.plan import stop_waves

        waves = len(stop_waves(self.nodes, {name: one.needs for name, one in self.nodes.items()}))
        patient_s = HEARD_WITHIN_S + waves * STOPPED_WITHIN_S
        asked = self._ask("shutdown", now=now)
        heard = False
        try:
            with contextlib.suppress(ConnectionLostError):
                await asyncio.wait_for(asked, HEARD_IN_A_HURRY_S if now else HEARD_WITHIN_S)
            heard = True
            await asyncio.wait_for(self._closed.wait(), ENDED_IN_A_HURRY_S if now else patient_s)
        except asyncio.TimeoutError:
            self._parting = self._parting or asyncio.create_task(self._part(heard=heard))
        if self._parting is not None:
            # An earlier call that is still waiting gets this error as well.
            raise SilentSupervisorError(await asyncio.shield(self._parting))
        await self.aclose()
        left = await left_behind(self.session.run_id)
        if left:
            raise StillRunningError(say("the session has ended, these have not: {who}", who=who(left)))

    async def _part(self, *, heard: bool) -> Words:
        """Kill a hung supervisor if we started it, else disconnect from it; say what is left."""
        try:
            if self._lifeline >= 0:
                return await kill_supervisor(self.session.run_id)
            pid = self.session.supervisor_pid
            return _endless(pid, left_of(self.session.run_id)) if heard else _silent(pid)
        finally:
            self._end()
            await self.aclose()

    async def aclose(self) -> None:
        """Disconnect. A foreground session ends if this client started it."""
        if self._lifeline >= 0:
            os.close(self._lifeline)
            self._lifeline = -1
        self._listening.cancel()
        with contextlib.suppress(asyncio.CancelledError):
            await self._listening
        self._writer.close()
        try:
            await asyncio.wait_for(self._writer.wait_closed(), UNSENT_WITHIN_S)
        except (OSError, asyncio.TimeoutError):
            self._writer.transport.abort()

    async def _ask(self, op: str, **arguments: object) -> Any:  # noqa: ANN401 - JSON
        if self._closed.is_set():
            raise ConnectionLostError(say("the session has ended"))
        request_id, self._next_id = self._next_id, self._next_id + 1
        future: asyncio.Future[Any] = asyncio.get_running_loop().create_future()
        self._replies[request_id] = future
        self._writer.write(encode({"id": request_id, "op": op, **arguments}))
        try:
            return await future
        finally:
            del self._replies[request_id]

    async def _listen(self) -> None:
        try:
            while True:
                line = await self._reader.readline()
                if not line:
                    break
                self._hear(read_json(line))
        except (OSError, ValueError):
            pass
        finally:
            self._end()

    def _end(self) -> None:
        self._closed.set()
        self._inbox.put(ClosedEvent(GONE))
        for future in self._replies.values():
            if not future.done():
                future.set_exception(ConnectionLostError(say("the session has ended")))

    def _hear(self, message: dict[str, Any]) -> None:
        event = unpack_event(message)
        if event is not None:
            self._take(event)
        elif "reply" in message:
            self._take_reply(message)

    def _take(self, event: Event) -> None:
        if isinstance(event, StatusEvent):
            self.nodes.update((node.name, node) for node in event.nodes)
        elif isinstance(event, StraysEvent):
            self.strays = event.strays
        elif isinstance(event, AgentsEvent):
            self.agents = event.agents
        elif isinstance(event, UnguardedEvent):
            self.unguarded = True
        self._inbox.put(event)

    def _take_reply(self, message: dict[str, Any]) -> None:
        future = self._replies.get(message["reply"])
        if future is None or future.done():
            return
        error = message.get("error")
        if error is None:
            future.set_result(message["result"])
        elif error["kind"] == "unknown_node":
            future.set_exception(UnknownNodeError(error["name"], error["known"]))
        elif error["kind"] == "still_running":
            future.set_exception(StillRunningError(unpack_text(error["message"])))
        else:
            future.set_exception(ProtocolError(error["message"]))
