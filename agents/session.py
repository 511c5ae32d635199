"""The session that agents look at: found, joined, and found again when it has ended."""

from __future__ import annotations

import asyncio
import contextlib
import os
import time
from pathlib import Path
from typing import TYPE_CHECKING

from agents.emergency import EmergencyWatch, StopPassing
from agents.refusal import refused
from agents.view import GraphView
from graph.observer.observer import Observer
from graph.observer.requests import PreparePublisher, TakeBack
from launcher.client import client
from launcher.consent import AUDIT_FILE
from launcher.errors import LauncherError, SessionError, SeveralRunningError, UsageError
from launcher.events import ClosedEvent
from launcher.private_files import open_file
from safety.topics import EMERGENCY_STOP
from text.output import json_text
from text.sentences import reason_of, say

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from concurrent.futures import Future

    from graph.data import GraphUpdate
    from launcher.client.client import SupervisorClient
    from launcher.status import SessionInfo
    from text.sentences import Words

LOOK_EVERY_S = 0.5
SAID_WITHIN_S = 1.0
BOOL = "std_msgs/msg/Bool"


MAX_ARGUMENTS = 4000
"""Most characters of the arguments that are kept."""


class Audit:
    """What agents have called, in the log folder of the run: one JSON object a line, mode 0600."""

    def __init__(self, log_dir: str) -> None:
        self.path = Path(log_dir) / AUDIT_FILE

    def write(self, agent: str, tool: str, arguments: Mapping[str, object], outcome: str, took_s: float) -> None:
        """Add a line: time (Unix), client, tool, arguments, outcome, seconds.

        Raises:
            OSError: if it cannot be written.
        """
        kept: object = dict(arguments)
        if len(text := json_text(kept)) > MAX_ARGUMENTS:
            kept = f"{text[:MAX_ARGUMENTS]} …"
        line = {
            "time": round(time.time(), 3),
            "client": agent,
            "tool": tool,
            "arguments": kept,
            "outcome": outcome[:MAX_ARGUMENTS],
            "seconds": round(took_s, 3),
        }
        descriptor = open_file(self.path, os.O_WRONLY | os.O_CREAT | os.O_APPEND)
        try:
            os.write(descriptor, (json_text(line) + "\n").encode(errors="backslashreplace"))
        finally:
            os.close(descriptor)


class RobotSession:
    """A running session: its supervisor, its graph, and the record of what agents do."""

    def __init__(self, link: SupervisorClient, stopped: Callable[[], None], discovery: str | None = None) -> None:
        """Begin to look; `stopped` is called while an emergency stop is in force.

        `discovery`: how far to look, by default as the session does.
        """
        self.link = link
        self.audit = Audit(link.session.log_dir)
        self.emergency, self._passing = EmergencyWatch(), StopPassing(link)
        self.observer = Observer(link.session.domain, discovery or link.session.discovery, role="agents")
        self.view = GraphView(self.observer)
        self.last_words: Future[int] | None = None
        """A stop of the wheels that has to be sent before the observer ends."""
        self.has_stopped = False
        """Whether an agent has given a stop that nobody has released yet."""
        self._stopped = stopped
        self._was_stopped = False
        self._ending: asyncio.Future[None] | None = None
        self._loop = asyncio.get_running_loop()
        self.observer.start(self._hand_over)
        # So that the first stop goes out at once.
        prepared = self.observer.ask(PreparePublisher(EMERGENCY_STOP, BOOL, latched=True))
        prepared.add_done_callback(lambda future: future.cancelled() or future.exception())

    @property
    def info(self) -> SessionInfo:
        return self.link.session

    async def settled(self) -> None:
        """Wait until the graph of the session is known, which takes seconds after the start."""
        serving = [node.name for node in self.link.nodes.values() if node.serves]
        await self.view.settled(f"/{name}" for name in serving)

    async def until_end(self) -> None:
        async for event in self.link.events():
            if isinstance(event, ClosedEvent):
                return

    async def close(self) -> None:
        if self.last_words is not None:
            await asyncio.wait([asyncio.wrap_future(self.last_words)], timeout=SAID_WITHIN_S)
        await asyncio.to_thread(self.observer.stop)
        await self.link.aclose()

    def _hand_over(self, update: GraphUpdate) -> None:
        # The loop may have been closed in the meantime.
        with contextlib.suppress(RuntimeError):
            self._loop.call_soon_threadsafe(self._take, update)

    def _take(self, update: GraphUpdate) -> None:
        stopped = self.emergency.see(update)
        self._passing.see(update)
        if stopped:
            self._stopped()
        if stopped and not self._was_stopped:
            # Also where no screen is: what a person has allowed before does not outlive a stop.
            self._ending = asyncio.ensure_future(self._end_consent())
        if self.has_stopped and self._was_stopped and not stopped:
            # Somebody has released it: a node that starts later must not hear of it from here.
            self.has_stopped = False
            self.observer.ask(TakeBack(EMERGENCY_STOP, BOOL))
        self._was_stopped = stopped
        self.view.take(update)

    async def _end_consent(self) -> None:
        with contextlib.suppress(LauncherError):
            await self.link.end_consent()


class SessionFinder:
    """Keeps to the session of a name or a domain, whenever it runs."""

    def __init__(
        self, name: str | None, domain: int | None, stopped: Callable[[], None], discovery: str | None = None
    ) -> None:
        self._name, self._domain, self._stopped = name, domain, stopped
        self._discovery = discovery
        self._now: RobotSession | None = None
        self._why: Words | str = say("no session has been looked for yet")
        self._looked = asyncio.Event()

    async def keep(self) -> None:
        """Look for the session, stay with it to its end, and look again; until cancelled."""
        while True:
            try:
                found = await self._find()
            except LauncherError as error:
                self._why = reason_of(error)
            except OSError as error:
                self._why = str(error)
            else:
                await self._stay(found)
                continue
            finally:
                self._looked.set()
            await asyncio.sleep(LOOK_EVERY_S)

    async def session(self) -> RobotSession:
        """Return the session.

        Raises:
            RefusedError: if there is none.
        """
        await self._looked.wait()
        if self._now is None:
            raise refused("no robot to speak to: {why}", why=self._told_why())
        return self._now

    def _told_why(self) -> Words | str:
        if self._discovery in (None, "localhost"):
            return self._why
        # Consent, limits and records are those of the robot's session.
        return say(
            "{why}. A robot on another machine is spoken to there: start deck mcp on it, over SSH", why=self._why
        )

    @property
    def now(self) -> RobotSession | None:
        """The session, None if there is none."""
        return self._now

    async def _find(self) -> SupervisorClient:
        if self._domain is None:
            return await client.attach(self._name)
        sessions = await asyncio.to_thread(client.running)
        here = [one for one in sessions if one.domain == self._domain]
        if self._name is not None:
            here = [one for one in here if self._name in (one.name, one.run_id, one.lesson)]
        if len(here) > 1:
            raise SeveralRunningError([one.name for one in here])
        if not here:
            raise UsageError(say("nothing is running in domain {domain}", domain=self._domain))
        return await client.attach(here[0].run_id)

    async def _stay(self, link: SupervisorClient) -> None:
        session = RobotSession(link, self._stopped, self._discovery)
        self._now = session
        self._looked.set()
        try:
            await session.until_end()
        finally:
            self._now = None
            self._why = say("the session {name} has ended", name=link.session.name)
            self._stopped()
            with contextlib.suppress(SessionError):
                await session.close()
