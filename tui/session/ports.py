"""The two ports of the screen: what it needs of the supervisor and of the ROS graph.

`launcher.client.client.SupervisorClient` and `graph.observer.observer.Observer` fit them, and so do
the recorded ones of the tests. A `SessionOpener` lists what can be opened and opens it. For type
checkers only: whoever runs needs none of it.
"""

from __future__ import annotations

from collections.abc import AsyncIterator, Callable, Iterable, Mapping
from concurrent.futures import Future
from typing import TYPE_CHECKING, Protocol

from graph.calls.timeouts import ANSWER_WITHIN_S

if TYPE_CHECKING:
    from graph.data import CallResult, GraphUpdate, ParametersResult, SetResult, Value
    from graph.publishing.dead_man_switch import Holding
    from launcher.events import Event
    from launcher.status import NodeStatus, SessionInfo, Stray
    from tui.session.requests import Lesson, OpenRequest


class SessionLink(Protocol):
    """A running profile: its nodes as they are now, and what can be asked of them."""

    @property
    def session(self) -> SessionInfo:
        """What runs: profile, domain, panels."""

    @property
    def own(self) -> bool:
        """Whether this screen has started it: then it ends with this screen."""

    @property
    def nodes(self) -> Mapping[str, NodeStatus]:
        """Every node by its name in the profile's request, kept current."""

    @property
    def strays(self) -> tuple[Stray, ...]:
        """Processes that an earlier run left behind."""

    def events(self, *, past: int = 0) -> AsyncIterator[Event]:
        """Yield the newest `past` lines of before, then what happens until the session ends."""

    async def start(self, *names: str) -> None:
        """Start these nodes, all if none is named."""

    async def stop(self, *names: str) -> None:
        """Stop these nodes, all if none is named."""

    async def restart(self, *names: str) -> None:
        """Stop and start these nodes, all if none is named."""

    async def stop_strays(self, strays: Iterable[Stray]) -> None:
        """End what an earlier run left behind."""

    async def shutdown(self, now: bool = False) -> None:
        """Stop all nodes, dependants first, and the supervisor; `now` skips the waiting."""

    async def aclose(self) -> None:
        """Let go of the session and leave it as it is."""


class GraphLink(Protocol):
    """The ROS graph of one domain; no method blocks, all may be called from any thread."""

    period_s: float
    """Seconds between two updates."""

    def start(self, on_update: Callable[[GraphUpdate], None]) -> None:
        """Begin to observe; `on_update` is called on the observer's own thread."""

    def stop(self) -> None:
        """End observing, within bounds."""

    def watch(self, topics: Iterable[str]) -> None:
        """Decode the newest message of exactly these topics each period."""

    def follow(self, topics: Iterable[str]) -> None:
        """Decode every message of exactly these topics."""

    def measure(self, all_topics: bool) -> None:
        """Measure the rates of all topics, or only of those watched and followed."""

    def watch_goals(self, actions: Iterable[str]) -> None:
        """Tell of the goals that others have sent to exactly these actions."""

    def prepare_publisher(
        self, topic: str, type_name: str, *, latched: bool = False
    ) -> Future[None]:
        """Make a publisher now, so that its first message goes out at once."""

    def publish(
        self, topic: str, type_name: str, value: Mapping[str, Value], *, latched: bool = False
    ) -> Future[int]:
        """Publish one message; the future tells how many it went to, or fails with a word why."""

    def call(
        self,
        service: str,
        type_name: str,
        request: Mapping[str, Value],
        timeout_s: float = ANSWER_WITHIN_S,
    ) -> Future[CallResult]:
        """Call a service."""

    def start_publishing(
        self, topic: str, type_name: str, value: Mapping[str, Value], hz: float
    ) -> Future[int]:
        """Publish a message again and again; the future tells its number, or fails."""

    def stop_publishing(self, number: int) -> None:
        """Publish that one no more; updates do not tell of it any longer."""

    def stop_publishing_all(self) -> None:
        """Publish nothing at a rate any more, not even what was asked for a moment ago."""

    def prepare_hold(self, topic: str, type_name: str) -> Future[None]:
        """Make a publisher for what may be held, and publish nothing."""

    def hold(self, topic: str, type_name: str, word: Holding) -> Future[int]:
        """Publish again and again until `word.until_s`, then its rest, then nothing."""

    def let_go(self, topic: str) -> None:
        """Publish the rest of what is held, at once."""

    def parameters(self, node: str, timeout_s: float = ANSWER_WITHIN_S) -> Future[ParametersResult]:
        """Read all parameters of a node with their descriptors; the future never raises."""

    def set_parameters(
        self, node: str, values: Mapping[str, Value], timeout_s: float = ANSWER_WITHIN_S
    ) -> Future[SetResult]:
        """Set parameters, each by the type that it has; the future never raises."""

    def send_goal(self, action: str, type_name: str, goal: Mapping[str, Value]) -> Future[int]:
        """Send a goal; the future tells its number, or fails. Updates tell how it goes."""

    def cancel_goal(self, number: int) -> None:
        """Ask for a goal to be cancelled."""

    def cancel_seen_goal(self, action: str, goal_id: str) -> None:
        """Ask for a goal of somebody else's to be cancelled; updates tell what came of it."""

    def forget_goal(self, number: int) -> None:
        """Tell no more of a goal; one that has not ended is cancelled."""


class SessionOpener(Protocol):
    """What can be opened, and the opening of it."""

    async def lessons(self) -> list[Lesson]:
        """Return every profile there is, broken ones with their error."""

    async def running(self) -> list[SessionInfo]:
        """Return the sessions that run in the background."""

    def domain(self, asked: int | None) -> int:
        """The ROS domain that `watch` means; raises a `LauncherError` if it is out of range."""

    async def prepare(self) -> None:
        """Make ready what can be, so that `open` is quick; to be called while a person chooses."""

    async def open(self, request: OpenRequest) -> SessionLink:
        """Start the profile or attach to the session; raises a `LauncherError` with the reason."""

    def observe(self, session: SessionInfo) -> GraphLink:
        """Return the ROS graph that this session's nodes live in, not yet observed."""
