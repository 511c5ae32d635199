"""A graph that was written down: it shows what it is told to, and notes what is asked of it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import Future
from dataclasses import dataclass, field, replace
from typing import Any

from graph.data import (
    CallResult,
    Goal,
    GoalStatus,
    GraphUpdate,
    ParameterRow,
    ParametersResult,
    Publication,
    SetResult,
)
from graph.publishing.dead_man_switch import HeldCommand
from tests.tui.recorded_inner import RecordedInner
from tests.tui.recorded_lesson import NOW_S, lesson_update

PARAMETERS: tuple[ParameterRow, ...] = (
    ParameterRow("frame_id", "string", "sonar_front", "Frame of the readings.", read_only=True),
    ParameterRow("rate", "double", 1.0, "Readings a second.", "above 0", False, 0.1, 50.0),
    ParameterRow("steps", "integer", 4, "", "", False, 0.0, 10.0, 2.0),
    ParameterRow("topic", "string", "/sensor/sonar_front"),
    ParameterRow("use_sim_time", "bool", False),
)
"""Of every node of which a test says nothing else."""


def done(result: Any, error: Exception | None = None) -> Future[Any]:
    """Return a future of which this has come already."""
    future: Future[Any] = Future()
    if error is None:
        future.set_result(result)
    else:
        future.set_exception(error)
    return future


@dataclass
class RecordedGraph:
    """A graph that shows what it is told to, and notes what is asked of it."""

    update: GraphUpdate | None = field(default_factory=lesson_update)
    """Shown at the start; None: nothing yet."""
    period_s: float = 0.25
    watched: set[str] = field(default_factory=set)
    followed: set[str] = field(default_factory=set)
    measured: bool = False
    measured_images: bool = True
    measured_fast: bool = True
    pictures: set[str] = field(default_factory=set)
    """Topics of which pictures are wanted."""
    stopped: bool = False
    published: list[tuple[str, str, Mapping[str, Any], bool]] = field(default_factory=list)
    """(topic, type, value, latched)."""
    prepared: list[tuple[str, str, bool]] = field(default_factory=list)
    called: list[tuple[str, str, Mapping[str, Any]]] = field(default_factory=list)
    waited_s: list[float] = field(default_factory=list)
    """How long the answer to each call may take."""
    publish_error: Exception | None = None
    """Set: every publishing fails by this."""
    answers: dict[str, CallResult] = field(default_factory=dict)
    """Service to answer, in place of a sum of 1."""
    hold_calls: bool = False
    """Set: calls are not answered until the test sets the futures of `waiting`."""
    waiting: list[Future[CallResult]] = field(default_factory=list)
    repeated: list[tuple[str, str, Mapping[str, Any], float]] = field(default_factory=list)
    """(topic, type, value, hz) that is published again and again."""
    stopped_publications: list[int] = field(default_factory=list)
    stopped_all: int = 0
    commands_nothing: bool = False
    """How often all that is published again and again was stopped."""
    held: list[tuple[str, str, HeldCommand]] = field(default_factory=list)
    """(topic, type, command) that is published while it is held."""
    let_go_of: list[str] = field(default_factory=list)
    """Topics whose rest was asked for."""
    node_parameters: dict[str, ParametersResult] = field(default_factory=dict)
    """Node to what it says of its parameters; others have `PARAMETERS`."""
    refusals: dict[str, str] = field(default_factory=dict)
    """Parameter to the reason why it is not set."""
    asked_parameters: list[str] = field(default_factory=list)
    """Nodes whose parameters were read."""
    set_to: list[tuple[str, Mapping[str, Any]]] = field(default_factory=list)
    """(node, values)."""
    sent_goals: list[tuple[str, str, Mapping[str, Any]]] = field(default_factory=list)
    """(action, type, goal)."""
    canceled_goals: list[int] = field(default_factory=list)
    forgotten_goals: list[int] = field(default_factory=list)
    inner: RecordedInner = field(default_factory=RecordedInner)
    inner_wanted: bool = False
    goals_watched: set[str] = field(default_factory=set)
    """Actions whose goals of others are wanted."""
    frames_watched: bool = False
    """Whether the frames are wanted."""
    canceled_of_others: list[tuple[str, str]] = field(default_factory=list)
    """(action, id of the goal)."""
    _on_update: Callable[[GraphUpdate], None] | None = None

    def start(self, on_update: Callable[[GraphUpdate], None]) -> None:
        self._on_update = on_update
        if self.update is not None:
            on_update(self.update)

    def show(self, update: GraphUpdate) -> None:
        self.update = update
        if self._on_update is not None:
            self._on_update(update)

    def stop(self) -> None:
        self.stopped = True

    def watch(self, topics: Iterable[str]) -> None:
        self.watched = set(topics)

    def follow(self, topics: Iterable[str]) -> None:
        self.followed = set(topics)

    def watch_pictures(self, topics: Iterable[str]) -> None:
        self.pictures = set(topics)

    def measure(self, all_topics: bool, *, images: bool = True, fast: bool = True) -> None:
        self.measured, self.measured_images, self.measured_fast = all_topics, images, fast

    def watch_inner_states(self, wanted: bool) -> None:
        self.inner_wanted = wanted

    def watch_goals(self, actions: Iterable[str]) -> None:
        self.goals_watched = set(actions)

    def watch_frames(self, wanted: bool) -> None:
        self.frames_watched = wanted

    def cancel_seen_goal(self, action: str, goal_id: str) -> None:
        self.canceled_of_others.append((action, goal_id))

    def prepare_publisher(self, topic: str, type_name: str, *, latched: bool = False) -> Future[None]:
        self.prepared.append((topic, type_name, latched))
        return done(None)

    def publish(self, topic: str, type_name: str, value: Mapping[str, Any], *, latched: bool = False) -> Future[int]:
        self.published.append((topic, type_name, value, latched))
        return done(1, self.publish_error)

    def call(
        self, service: str, type_name: str, request: Mapping[str, Any], timeout_s: float = 5.0
    ) -> Future[CallResult]:
        self.waited_s.append(timeout_s)
        self.called.append((service, type_name, request))
        if self.hold_calls:
            self.waiting.append(Future())
            return self.waiting[-1]
        return done(self.answers.get(service, CallResult(service, True, {"sum": 1}, "", 0.012)))

    def start_publishing(self, topic: str, type_name: str, value: Mapping[str, Any], hz: float) -> Future[int]:
        self.repeated.append((topic, type_name, value, hz))
        number = len(self.repeated)
        if self.publish_error is None:
            one = Publication(number, topic, type_name, hz, 0, 1)
            self._change(publications=(*self._now.publications, one))
        return done(number, self.publish_error)

    def stop_publishing(self, number: int) -> None:
        self.stopped_publications.append(number)
        kept = [one for one in self._now.publications if one.number != number]
        self._change(publications=tuple(kept))

    def stop_publishing_all(self) -> None:
        self.stopped_all += 1
        if self.update is not None and self.update.publications:
            self._change(publications=())

    def stop_commanding(self) -> None:
        self.commands_nothing = True

    def prepare_hold(self, topic: str, type_name: str) -> Future[None]:
        return self.prepare_publisher(topic, type_name)

    def hold(self, topic: str, type_name: str, command: HeldCommand) -> Future[int]:
        self.held.append((topic, type_name, command))
        return done(1, self.publish_error)

    def let_go(self, topic: str) -> None:
        self.let_go_of.append(topic)

    def parameters(self, node: str, timeout_s: float = 5.0) -> Future[ParametersResult]:
        del timeout_s
        self.asked_parameters.append(node)
        return done(self._known(node))

    def _known(self, node: str) -> ParametersResult:
        return self.node_parameters.get(node, ParametersResult(node, PARAMETERS, "", 0.01))

    def set_parameters(self, node: str, values: Mapping[str, Any], timeout_s: float = 5.0) -> Future[SetResult]:
        del timeout_s
        self.set_to.append((node, values))
        refused = {name: why for name, why in self.refusals.items() if name in values}
        known = self._known(node)
        taken = {name: value for name, value in values.items() if name not in refused}
        rows = tuple(replace(row, value=taken.get(row.name, row.value)) for row in known.parameters)
        self.node_parameters[node] = replace(known, parameters=rows)
        return done(SetResult(node, refused, "", 0.01))

    def send_goal(self, action: str, type_name: str, goal: Mapping[str, Any]) -> Future[int]:
        self.sent_goals.append((action, type_name, goal))
        number = len(self.sent_goals)
        if self.publish_error is None:
            one = Goal(number, action, type_name, GoalStatus.SENDING, goal)
            self._change(goals=(*self._now.goals, one))
        return done(number, self.publish_error)

    def cancel_goal(self, number: int) -> None:
        self.canceled_goals.append(number)

    def forget_goal(self, number: int) -> None:
        self.forgotten_goals.append(number)
        self._change(goals=tuple(one for one in self._now.goals if one.number != number))

    def change_goal(self, number: int, **more: Any) -> None:
        """Let a goal that was sent be otherwise: its status, feedback, result."""
        goals = (replace(one, **more) if one.number == number else one for one in self._now.goals)
        self._change(goals=tuple(goals))

    @property
    def _now(self) -> GraphUpdate:
        return self.update or GraphUpdate(NOW_S)

    def _change(self, **more: Any) -> None:
        self.show(replace(self._now, **more))
