"""The current state of the session and its graph, sent to every screen that has been opened.

Events of the session arrive on the app's own loop, updates of the graph come from the observer's
thread through an inbox.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Collection, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Protocol, runtime_checkable

from textual.message import Message

from graph.data import Interest
from graph.observer.requests import StopCommanding
from launcher.consent import Agents
from text.i18n import _
from text.robot import robot
from tui.session.messages import AgentsChanged, GraphChanged, LogArrived, SessionChanged, StatusChanged
from tui.session.outside import ROSOUT, Outside, RosoutReader
from tui.session.past import KEPT_LINES, TRENDS, GraphInbox, LogHistory, Past, ended_nodes, silent_graph
from tui.session.watching import WATCH

if TYPE_CHECKING:
    from textual.app import App

    from graph.data import GraphUpdate
    from graph.replay.replay import Replay
    from launcher.events import Event
    from launcher.status import LogLine, NodeStatus, SessionInfo, Stray
    from tui.faults import Faults
    from tui.session.ports import GraphLink, SessionLink


class GraphReady(Message, bubble=False):
    """An update of the graph is waiting in the inbox."""


@runtime_checkable
class SessionScreen(Protocol):
    """A screen that follows the session."""

    period_s: float
    """Seconds between two updates of the graph while it is in front."""
    measure_all: bool
    """Whether the rates of every topic are needed while it is in front."""
    measure_images: bool
    """Whether those of topics with pictures are, too."""
    wants_frames: bool
    """Whether the frames of /tf and /tf_static are needed while it is in front."""

    def watch_topics(self) -> set[str]:
        """Return the topics whose newest message is needed while it is in front."""

    def follow_topics(self) -> set[str]:
        """Return the topics of which every message is needed, even while another is in front."""

    def keep_topics(self) -> set[str]:
        """Return the watched topics that are needed even while another is in front."""

    def picture_topics(self) -> set[str]:
        """Return the topics of which it shows the pictures now."""

    def past_topics(self) -> set[str]:
        """Return the topics of which it shows the past, also that before it was opened."""

    def watch_goals(self) -> set[str]:
        """Return the actions whose goals from others are needed while it is in front."""

    def show_frame(self) -> None:
        """Show title, session and emergency stop in their current state."""

    async def ros2_command(self) -> str:
        """Return what is chosen as a command line of `ros2`, empty if there is none."""

    def post_message(self, message: Message) -> bool:
        """Receive a message."""


class SessionOwner(Protocol):
    """Opens the session, and disconnects from it."""

    def ask_about(self, found: Sequence[Stray]) -> None:
        """Offer to stop what an earlier run left behind."""

    async def ended(self, reason: str) -> None:
        """Disconnect from a session that has ended."""


class Feed:
    """What is known about the session; only the feed sends it to screens."""

    def __init__(self, app: App[Any], followed: Collection[str], faults: Faults) -> None:
        """Post to the screens of `app`; the `followed` topics are always needed."""
        self._app = app
        self._followed = frozenset(followed)
        self._faults = faults
        self._inbox = GraphInbox(lambda: app.post_message(GraphReady()))
        self._screens: list[SessionScreen] = []
        self.link: SessionLink | None = None
        """None while there is no session."""
        self.graph: GraphLink | None = None
        self.replay: Replay | None = None
        """The recording that is played in place of a robot, None for a robot."""
        self.update: GraphUpdate | None = None
        """The newest update of the graph; None before the first."""
        self.history = LogHistory()
        self.past = Past()
        """What has come since the session began; not of a recording, which goes to and fro."""
        self.outside = Outside()
        """Nodes in the domain that Deck did not start."""
        self._rosout = RosoutReader()
        self._measures_all = False
        """Whether a dialog needs the rates of every topic."""
        self.ended = ""
        """Why the previous session has ended."""
        self._ended_nodes: Mapping[str, NodeStatus] = {}
        """The nodes of that session."""

    @property
    def agents(self) -> Agents:
        return Agents() if self.link is None else self.link.agents

    @property
    def blind(self) -> str:
        """The headline above the reason why nothing can be seen; a replay does not need ROS."""
        if self.replay is not None:
            return _("The recording cannot be read")
        return _("ROS cannot be observed")

    @property
    def watching(self) -> bool:
        """Whether others have started the nodes, and Deck only watches them."""
        return self.link is not None and self.link.session.run_id == WATCH

    @property
    def of_others(self) -> bool:
        """Whether the session was started elsewhere, and can be stopped from here."""
        link = self.link
        return link is not None and not (link.own or self.watching or self.replay is not None)

    @property
    def session(self) -> SessionInfo | None:
        """The session, None if there is none."""
        return None if self.link is None else self.link.session

    @property
    def nodes(self) -> Mapping[str, NodeStatus]:
        """Every node of the session, in the profile's order; also after the session has ended."""
        return self._ended_nodes if self.link is None else self.link.nodes

    @property
    def opened(self) -> bool:
        """Whether a session is shown, even one that has ended."""
        return self.link is not None or bool(self.ended)

    @property
    def front(self) -> SessionScreen | None:
        """The session screen that is in front, below any dialog."""
        stack = reversed(self._app.screen_stack)
        return next((screen for screen in stack if isinstance(screen, SessionScreen)), None)

    def connect(self, link: SessionLink, graph: GraphLink, replay: Replay | None = None) -> None:
        """Show this session from now on; `replay` if it is a recording."""
        self.link, self.graph, self.replay = link, graph, replay
        self.update, self.ended, self._ended_nodes = None, "", {}
        self.history.clear()
        self.past.clear()
        self.outside.forget()
        self._rosout = RosoutReader()
        self.tell(SessionChanged)
        self._tell_status(frozenset(link.nodes))
        self.ask_for_topics()
        graph.start(self._inbox.put)

    async def disconnect(self, ended: str = "") -> None:
        """Disconnect from the session without stopping it."""
        link, graph = self.link, self.graph
        self.link = self.graph = self.replay = None
        self.ended = ended
        self.outside.forget()
        if ended and link is not None:
            self._show_ended(link.nodes)
        if link is not None:
            await link.aclose()
        self.tell(lambda: SessionChanged(ended))
        if graph is not None:
            await asyncio.to_thread(graph.stop)

    def _show_ended(self, nodes: Mapping[str, NodeStatus]) -> None:
        self._ended_nodes = ended_nodes(nodes, self.ended)
        self._tell_status(frozenset(nodes))
        if self.update is not None:
            silent = self.update = silent_graph(self.update)
            self.tell(lambda: GraphChanged(silent))

    def close(self) -> None:
        """Forget the session that has ended, and its screens."""
        self.ended, self._ended_nodes = "", {}
        self._screens.clear()
        self.history.clear()
        self.past.clear()

    def log_file(self, node: str) -> str:
        """Return the path of the file with all lines of a node, empty if there is none."""
        folder = "" if self.session is None else self.session.log_dir
        return f"{folder}/{node}.log" if folder and node in self.nodes else ""

    def note(self, lines: Sequence[LogLine]) -> None:
        """Add Deck's own lines to the log."""
        self.history.add(lines)
        self.tell(lambda: LogArrived(tuple(lines), {}))

    async def listen(self, owner: SessionOwner) -> None:
        """Forward the events of the session until it ends: to the screens, or to its `owner`."""
        link = self.link
        if link is None:
            return
        async for event in link.events(past=KEPT_LINES):
            if link is not self.link:
                return
            try:
                await self._on_event(event, owner)
            except Exception as error:  # noqa: BLE001 - raised again where faults are not isolated
                self._faults.caught(error)

    async def _on_event(self, event: Event, owner: SessionOwner) -> None:
        # Not needed for the first frame.
        from launcher.events import AgentsEvent, ClosedEvent, LogEvent, StatusEvent, StraysEvent, UnguardedEvent

        if isinstance(event, StatusEvent):
            self._tell_status(frozenset(node.name for node in event.nodes))
        elif isinstance(event, LogEvent):
            self.history.add(event.lines)
            self.outside.note(event.lines)
            self.tell(lambda: LogArrived(event.lines, event.skipped))
        elif isinstance(event, StraysEvent):
            owner.ask_about(event.strays)
        elif isinstance(event, AgentsEvent):
            self._app.post_message(AgentsChanged())
            self.tell(AgentsChanged)
        elif isinstance(event, UnguardedEvent):
            if self.front is not None:
                # The title shows it.
                self.front.show_frame()
        elif isinstance(event, ClosedEvent):
            if self.graph is not None:
                # Before anything that takes time: nobody is in charge any more.
                self.graph.ask(StopCommanding())
            await owner.ended(event.reason)

    def take_update(self) -> GraphUpdate | None:
        update = self._inbox.take()
        if update is None or self.graph is None:
            return None
        self.update = update
        return update

    def hand_over(self, update: GraphUpdate) -> None:
        """Send an update to the screens that need it."""
        if self.replay is None:
            self.past.take(update)
        self._see_outside(update)
        front = self.front
        for screen in self._screens:
            wanted = screen.follow_topics() | screen.keep_topics()
            if screen is front or not update.samples.keys().isdisjoint(wanted):
                screen.post_message(GraphChanged(update))
        self._note_rosout(update)

    def _see_outside(self, update: GraphUpdate) -> None:
        session = self.session
        if session is None or self._hears_everybody:
            return
        if self.outside.see(update, self.nodes, session.run_id):
            self.ask_for_topics()

    @property
    def _is_here(self) -> bool:
        """Whether the nodes are on this machine, so that it costs little to know their rates before somebody asks."""
        return self.session is not None and not self._hears_everybody and self.session.discovery == "localhost"

    @property
    def _hears_everybody(self) -> bool:
        """Whether Deck started none of the nodes, as in a recording."""
        return self.watching or self.replay is not None

    def _note_rosout(self, update: GraphUpdate) -> None:
        """Read /rosout, the only source of log lines from nodes that others have started."""
        samples = update.samples.get(ROSOUT, ())
        if self._hears_everybody:
            lines = self._rosout.lines(samples)
        else:
            lines = self.outside.lines(samples, self.nodes) if self.outside.now else ()
        if lines:
            self.note(lines)

    def catch_up(self, screen: SessionScreen) -> None:
        """Send the current state to a screen that was just opened, and keep it up to date."""
        if screen in self._screens:
            return
        self._screens.append(screen)
        if not self.opened:
            return
        screen.post_message(SessionChanged())
        screen.post_message(StatusChanged(dict(self.nodes), frozenset(self.nodes)))
        if self.history:
            screen.post_message(LogArrived(self.history.all(), {}))
        if self.update is not None:
            screen.post_message(GraphChanged(self.past.before(self.update, screen.past_topics())))

    def forget(self, screen: SessionScreen) -> None:
        """Send nothing more to this screen."""
        if screen in self._screens:
            self._screens.remove(screen)

    def ask_for_topics(self) -> None:
        """Request the topics of the screen in front, and those that any screen follows or keeps."""
        graph, front = self.graph, self.front
        if graph is None:
            return
        own = {ROSOUT} if self._hears_everybody or self.outside.now else set[str]()
        followed = own.union(self._followed).union(*(screen.follow_topics() for screen in self._screens))
        kept: set[str] = set().union(*(screen.keep_topics() for screen in self._screens))
        if self.replay is None:
            followed |= set(robot().story)
            kept |= set(TRENDS)
        looks = self._measures_all or (front is not None and front.measure_all)
        graph.want(
            Interest(
                watched=frozenset(kept if front is None else kept | front.watch_topics()),
                followed=frozenset(followed),
                all_topics=looks or self._is_here,
                actions=frozenset(() if front is None else front.watch_goals()),
                inner_states=True,
                frames=front is not None and front.wants_frames,
                pictures=frozenset(() if front is None else front.picture_topics()),
                all_images=self._measures_all or (looks and front is not None and front.measure_images),
                all_fast=looks,
                period_s=0.25 if front is None else front.period_s,
            )
        )

    def measure_all(self, wanted: bool) -> None:
        """Measure the rates of every topic, whatever the screen in front needs."""
        self._measures_all = wanted
        self.ask_for_topics()

    def _tell_status(self, changed: frozenset[str]) -> None:
        nodes = dict(self.nodes)
        self.tell(lambda: StatusChanged(nodes, changed))

    def tell(self, make: Callable[[], Message]) -> None:
        """Post a separate message to every screen, since Textual marks a message as handled."""
        for screen in self._screens:
            screen.post_message(make())
