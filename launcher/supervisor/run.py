"""One run of the supervisor, from its plan to its end."""

from __future__ import annotations

import asyncio
import contextlib
import json
import os
import signal
import time
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Annotated

from launcher.control.requests import BadRequestError, request
from launcher.control.server import Client, ControlServer
from launcher.domain.discovery import why_open
from launcher.domain.participants import other_users
from launcher.errors import StillRunningError
from launcher.events import Hello
from launcher.logs.files import LogFiles, make_log_folder, prune_runs
from launcher.logs.session_log import AGENT, DECK, SessionLog
from launcher.private_files import open_file
from launcher.processes.exit import Reaper
from launcher.processes.members import Members
from launcher.processes.owner import who_runs, who_words
from launcher.processes.stop import end_all
from launcher.runs.record import RunRecord, exclusively, supervisors
from launcher.runs.run_folder import RunFolder
from launcher.runs.shared_domain import Neighbour, free_domain, rival
from launcher.runs.strays import end_strays, find_strays, forget_ended_runs
from launcher.spawn_server import SpawnRequest
from launcher.spawn_server.spawner import Spawner, SpawnError
from launcher.spawn_server.start import SpawnServerHandle
from launcher.status import Severity, Stray
from launcher.supervisor.plan import Plan
from launcher.supervisor.process import ProcessLauncher, helping, orphans
from launcher.supervisor.session import Session
from launcher.supervisor.words import who
from launcher.wire import MAX_MESSAGE_BYTES, encode, pack
from robot.safety.stop_file import BY_SCREEN, StopFile
from robot.safety.stop_record import Stop
from text.os_words import os_reason
from text.packing import pack_text
from text.run_path import OWN_RUN_DIR
from text.sentences import Words, say

MAX_NS = 1 << 62
LAST_WORDS = "supervisor"
"""Name of the log with the supervisor's own output, above all its tracebacks."""
HURRIED_S = 5.0
"""A process that outlives SIGKILL by this time is stuck in the kernel; we stop waiting for it."""
RELAY = "graph.picture_relay"
RELAY_AFTER_S, LONGEST_RELAY_S = 3.0, 60.0
"""The nodes go first. So long after the end of one relay another is started: twice as long each
time, unless it has worked for a while."""
STRAYS_AGAIN_S = 3.0
"""Processes of a run that ended a moment ago may still be ending."""


async def run(run_id: str, spawn_server: SpawnServerHandle, client: int) -> None:
    """Read the plan, carry it out, and clean up; `client` is the process that started this one."""
    stdin = await _open_stdin()
    line = await stdin.readline()
    if not line.endswith(b"\n"):
        return  # The profile was invalid, or the client is gone: there is nothing to do.
    plan = Plan.from_json(line)
    run_folder = RunFolder(_record(plan, run_id, client))
    try:
        if _claim(run_folder, plan):
            await Supervisor(plan, run_folder, spawn_server).run(stdin)
    finally:
        run_folder.remove()


async def _open_stdin() -> asyncio.StreamReader:
    reader = asyncio.StreamReader(limit=MAX_MESSAGE_BYTES)
    await asyncio.get_running_loop().connect_read_pipe(
        lambda: asyncio.StreamReaderProtocol(reader), os.fdopen(os.dup(0), "rb", 0)
    )
    return reader


def _record(plan: Plan, run_id: str, client: int) -> RunRecord:
    session = replace(
        plan.session,
        run_id=run_id,
        supervisor_pid=os.getpid(),
        log_dir=str(Path(plan.session.log_dir, plan.session.name, run_id)),
        started_by=who_runs(client),
        since_s=time.time(),
    )
    nodes = tuple(node.name for node in plan.nodes)
    return RunRecord(Path(plan.run_dir, run_id), session, nodes, plan.drives)


def _claim(run_folder: RunFolder, plan: Plan) -> bool:
    """Claim the domain for this run, unless another one has these nodes in it."""
    folder = run_folder.run_dir
    try:
        with exclusively(folder, plan.session.domain):
            everyone = list(supervisors())
            other = rival(everyone, run_folder.record)
            if other is not None:
                _answer(_refusal(other, free_domain(everyone, plan.session.domain)))
                return False
            run_folder.settle()
        folder = Path(run_folder.record.session.log_dir)
        make_log_folder(folder, (DECK, AGENT, LAST_WORDS, *run_folder.record.nodes))
        _keep_last_words(folder)
    except OSError as problem:
        _answer({"no_room": pack_text(_no_room(folder, problem))})
        return False
    return True


def _refusal(other: Neighbour, free: int) -> dict[str, object]:
    elsewhere = other.purpose != os.environ.get(OWN_RUN_DIR, "")
    return {
        "running": pack(other.record.session),
        "run_dir": other.run_dir if elsewhere else "",
        "down": other.down if elsewhere else "deck down",
        "free": free,
    }


def _no_room(folder: Path, problem: OSError) -> Words:
    return say("{path} cannot be written: {reason}", path=folder, reason=os_reason(problem))


def _answer(message: Mapping[str, object]) -> None:
    """Write the one line to stdout, then close it: nobody reads it any more."""
    with contextlib.suppress(BrokenPipeError):
        os.write(1, encode(message))
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    os.close(nowhere)


def _keep_last_words(folder: Path) -> None:
    """Redirect stderr to a file: the client may be gone long before this process."""
    words = open_file(folder / f"{LAST_WORDS}.log", os.O_WRONLY | os.O_CREAT | os.O_APPEND)
    os.dup2(words, 2)
    os.close(words)


def _check(problem: str) -> None:
    if problem:
        raise BadRequestError(say("the emergency stop on disk cannot be changed: {problem}", problem=problem))


def _time_ns(number: object) -> object:
    if isinstance(number, int) and not 0 < number < MAX_NS:
        raise ValueError(f"{number} is no time")
    return number


SaidNs = Annotated[int, _time_ns]
"""Unix time; by default that at which a request arrives."""


class Supervisor:
    """One run, from start to end."""

    def __init__(self, plan: Plan, run_folder: RunFolder, spawn_server: SpawnServerHandle) -> None:
        self.info = run_folder.record.session
        self.strays: tuple[Stray, ...] = ()
        self.unguarded = False
        """Whether the guardian is gone; it was the parent, so it cannot be started again."""
        self._plan = plan
        self._run_folder = run_folder
        self._loop = asyncio.get_running_loop()
        self._reaper = Reaper()
        self._spawner = Spawner(self.info.run_id, spawn_server, self._warn)
        if not plan.warm:
            self._spawner.go_cold()
        self._files = LogFiles(Path(self.info.log_dir), self._log_failed)
        self.control = ControlServer(
            self._hello, lambda: self._log.rings, lambda severity, words: self._log.say(AGENT, severity, words)
        )
        self._log = SessionLog((node.name for node in plan.nodes), self._files, self.control.lines_came)
        members = Members(self.info.run_id)
        launcher = ProcessLauncher(plan, self._spawner, self._reaper, members, self._log)
        self._session = Session(plan, launcher, self._log, self.control.status_changed)
        open_because = why_open(os.environ, plan.session.discovery)
        if open_because:
            self._log.say(DECK, Severity.WARN, open_because)
        self._stop_file = StopFile(self.info.domain, "/supervisor")
        self._end = asyncio.Event()
        self._hurry = asyncio.Event()
        self._reason = ""

    async def run(self, stdin: asyncio.StreamReader) -> None:
        self._reaper.install(self._loop)
        self._install_signals()
        self._watch_guardian()
        try:
            listener = self._run_folder.listen()
        except OSError as problem:
            folder = self._run_folder.record.folder
            _answer({"no_room": pack_text(_no_room(folder, problem))})
            self._spawner.close()
            self._files.close()
            return
        self.control.take_requests_for(self, self._session)
        await self.control.serve(listener)
        self._tell_of_other_users()
        self._session.start()
        _answer({"folder": str(self._run_folder.record.folder)})
        helpers = [
            asyncio.create_task(self._session.measure()),
            asyncio.create_task(_relay_pictures(self._plan, self._spawner, self._reaper)),
            asyncio.create_task(self._look_for_strays()),
            asyncio.create_task(self._run_folder.keep(self.control.serve, self._warn)),
            asyncio.create_task(self._watch_owner(stdin)),
            asyncio.create_task(self._session.own_files.watch()),
        ]
        await self._end.wait()
        await self._stop_all()
        for helper in helpers:
            helper.cancel()
        self._spawner.close()
        # When clients learn that it is over, the logs must be complete and the domain free.
        self._files.close()
        self._run_folder.remove()
        await self.control.close(self._reason)

    def _hello(self) -> Hello:
        nodes = tuple(node.status() for node in self._session.nodes.values())
        return Hello(self.info, nodes, self.strays, unguarded=self.unguarded)

    # Requests of clients; those about nodes are the session's.

    @request
    async def stop_strays(self, strays: tuple[Stray, ...]) -> None:
        """End these processes that an earlier run left behind."""
        await end_strays(strays)
        self._find_strays()

    @request
    async def emergency_stop(self, said_ns: SaidNs = 0) -> None:
        """Give an emergency stop by the file that the nodes watch."""
        _check(await asyncio.to_thread(self._stop_file.give, Stop(said_ns or time.time_ns()), BY_SCREEN))

    @request
    async def emergency_release(self, said_ns: SaidNs = 0) -> None:
        """Release what was given before this time in the same way."""
        _check(await asyncio.to_thread(self._stop_file.release, said_ns or time.time_ns()))

    @request
    def shutdown(self, client: Client, now: bool = False) -> None:
        """Begin to stop all nodes and then the supervisor."""
        if client.pid == self.info.started_by.pid:
            reason = say("stopped")
        else:
            reason = say("ended from elsewhere: {who}", who=who_words(who_runs(client.pid)))
        self._finish(reason, now=now or self._end.is_set())

    # Events.

    def _finish(self, reason: Words, *, now: bool) -> None:
        if not self._end.is_set():
            self._reason = reason
            self._session.ends = True
            self._end.set()
        if now:
            self._hurry.set()

    async def _stop_all(self) -> None:
        """Stop all nodes and what they left behind; kill what hangs, within a time limit."""
        stopping = [asyncio.create_task(self._stop_nodes(now=self._hurry.is_set()))]
        hurry = asyncio.create_task(self._hurry.wait())
        await asyncio.wait([*stopping, hurry], return_when=asyncio.FIRST_COMPLETED)
        if not stopping[0].done():
            stopping.append(asyncio.create_task(self._stop_nodes(now=True)))
            await asyncio.wait(stopping, timeout=HURRIED_S)
        hurry.cancel()
        # Processes that can no longer be attributed to their node.
        run_id, spawner = self.info.run_id, self._spawner
        left = await end_all(lambda: orphans(run_id, spawner), self._session.clock, HURRIED_S)
        if left:
            words = say("{reason}; still running: {who}", reason=self._reason, who=who(left))
            self._reason = words
            self._log.say(DECK, Severity.ERROR, words)

    async def _stop_nodes(self, *, now: bool) -> None:
        # What is still running is looked up, and told, once all nodes have been stopped.
        with contextlib.suppress(StillRunningError):
            await self._session.stop(now=now)

    def _install_signals(self) -> None:
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            if number == signal.SIGHUP and not self.info.foreground:
                signal.signal(number, signal.SIG_IGN)
            else:
                self._loop.add_signal_handler(number, self._on_signal, number)

    def _watch_guardian(self) -> None:
        with contextlib.suppress(OSError):
            guardian = os.getppid()
            held = os.pidfd_open(guardian)
            self._loop.add_reader(held, self._guardian_gone, guardian, held)

    def _guardian_gone(self, guardian: int, held: int) -> None:
        self._loop.remove_reader(held)
        os.close(held)
        self.unguarded = True
        self.control.guardian_lost()
        words = say(
            "the guardian (pid {pid}) ended: if the supervisor is killed now, background "
            "processes of nodes may keep running",
            pid=guardian,
        )
        self._warn(words)

    def _on_signal(self, number: signal.Signals) -> None:
        self._finish(say("{signal} received", signal=number.name), now=self._end.is_set())

    async def _watch_owner(self, stdin: asyncio.StreamReader) -> None:
        """End a foreground session with the client that started it."""
        while await stdin.read(65536):
            pass
        if self.info.foreground:
            # An end that it had begun is carried out as it was asked for.
            self._finish(say("the screen that started it is gone"), now=not self._end.is_set())

    def _warn(self, words: Words) -> None:
        self._log.say(DECK, Severity.WARN, words)

    def _tell_of_other_users(self) -> None:
        """Log which other users of this machine could see and drive this robot."""
        users = other_users(self.info.domain)
        if users:
            words = say(
                "{users} also have ROS processes in domain {domain} on this machine; choose another with `--domain`",
                users=", ".join(users),
                domain=self.info.domain,
            )
            self._warn(words)

    def _log_failed(self, reason: str) -> None:
        words = say("{folder}: {reason}", folder=self.info.log_dir, reason=reason)
        self._loop.call_soon_threadsafe(self._log.say, DECK, Severity.ERROR, words)

    async def _look_for_strays(self) -> None:
        self._find_strays()
        await asyncio.to_thread(prune_runs, Path(self.info.log_dir).parent)
        if self.strays:
            await asyncio.sleep(STRAYS_AGAIN_S)
            self._find_strays()

    def _find_strays(self) -> None:
        run_dir = self._run_folder.run_dir
        strays = find_strays()
        forget_ended_runs(run_dir, strays)
        if strays != self.strays:
            self.strays = strays
            self.control.strays_changed(strays)


async def _relay_pictures(plan: Plan, spawner: Spawner, reaper: Reaper) -> None:
    """Keep the relay running until this is cancelled; a local session needs none."""
    if plan.session.discovery == "localhost":
        return
    where = json.dumps([plan.session.domain, plan.session.discovery])
    request = SpawnRequest("module", "deck_relay", "deck: relay", (RELAY, where), "/", plan.env)
    after_s = RELAY_AFTER_S
    while True:
        await asyncio.sleep(after_s)
        began_s = time.monotonic()
        with contextlib.suppress(SpawnError):
            async with helping(spawner, reaper, request) as words:
                async for _line in words:
                    pass
        lasted = time.monotonic() - began_s > LONGEST_RELAY_S
        after_s = RELAY_AFTER_S if lasted else min(2 * after_s, LONGEST_RELAY_S)
