"""A session in which Deck has started nothing: it only watches a ROS domain."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable, Iterable, Mapping
from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING

from graph.housekeeping import is_housekeeping
from launcher.consent import Agents

if TYPE_CHECKING:
    from pathlib import Path

    from graph.data import GraphUpdate
    from launcher.client.stop_road import StopRoad
    from launcher.consent import ConsentAnswer
    from launcher.events import Event
    from launcher.status import NodeStatus, SessionInfo, Stray

WATCH = "watch"
"""The name of the session, where a profile's would stand."""


class StopRoads:
    """Asks the supervisors of this user in a domain for the emergency stop, or its release.

    They are looked up each time: a session may have begun or ended meanwhile.
    """

    def __init__(self, domain: int) -> None:
        self._domain = domain
        self._carrying = ThreadPoolExecutor(1, "stop roads")
        """One after the other: a release must not overtake its stop."""
        self._roads: dict[Path, StopRoad] = {}

    def __call__(self, engaged: bool, said_ns: int) -> None:
        """Give the stop, or release it, as `StopRoad` does."""
        self._carrying.submit(self._carry, engaged, said_ns)

    def _carry(self, engaged: bool, said_ns: int) -> None:
        # Loaded once the first frame is drawn, see `tui.lifecycle.opener.OF_STOP`.
        from launcher.client.running import running_records
        from launcher.client.stop_road import StopRoad

        for record in running_records():
            if record.session.domain == self._domain:
                road = self._roads.setdefault(record.folder, StopRoad(record.folder, self._domain))
                road(engaged, said_ns)


class NodelessLink:
    """A `SessionLink` without nodes: there is nothing to start, stop or restart."""

    def __init__(
        self, session: SessionInfo, emergency_stop: Callable[[bool, int], None] = lambda _engaged, _said_ns: None
    ) -> None:
        """`emergency_stop`: the road beside the topic; a recording has none."""
        self.session = session
        self.emergency_stop = emergency_stop
        self.own = False
        self.nodes: Mapping[str, NodeStatus] = {}
        self.strays: tuple[Stray, ...] = ()
        self.agents = Agents()
        self.unguarded = False
        self._closed = asyncio.Event()

    async def events(self, *, past: int = 0) -> AsyncIterator[Event]:
        """Yield nothing until the session is closed: there is no earlier log either."""
        del past
        nothing: tuple[Event, ...] = ()
        for event in nothing:
            yield event
        await self._closed.wait()

    async def start(self, *names: str) -> None:
        """Nothing to start."""

    async def stop(self, *names: str) -> None:
        """Nothing to stop: others have started the nodes."""

    async def restart(self, *names: str) -> None:
        """Nothing to restart."""

    async def exchange(self, name: str, program: Path | str | None) -> None:
        """Nothing to exchange."""

    async def stop_strays(self, strays: Iterable[Stray]) -> None:
        """Nothing was left behind."""

    async def attend(self) -> None:
        """Nobody asks."""

    async def answer(self, question: int, answer: ConsentAnswer) -> bool:
        del question, answer
        return False

    async def end_consent(self) -> None:
        """Nothing was allowed."""

    async def shutdown(self, now: bool = False) -> None:
        del now
        self._closed.set()

    async def aclose(self) -> None:
        self._closed.set()


def watched(domain: int, discovery: str = "localhost") -> NodelessLink:
    """Return the session for whatever runs in this domain.

    `discovery`: `localhost` for this machine only, `subnet` for the network too.
    """
    from launcher.status import SessionInfo

    title = {"en": "What runs in the domain", "ru": "Что работает в домене"}
    return NodelessLink(
        SessionInfo(
            run_id=WATCH,
            profile="",
            name=WATCH,
            title=title,
            domain=domain,
            discovery=discovery,
            hardware="",
            foreground=False,
        ),
        StopRoads(domain),
    )


def robot_nodes(update: GraphUpdate) -> list[str]:
    """Return the full names of the nodes that are listed by default."""
    return [node.name for node in update.nodes if not is_housekeeping(node.name)]
