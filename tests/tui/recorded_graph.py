"""A graph that was written down: it shows what it is told to, and notes what is asked of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from concurrent.futures import Future
from dataclasses import dataclass, field, replace
from typing import Any, TypeVar

from graph.data import (
    CallResult,
    Goal,
    GoalStatus,
    GraphUpdate,
    Interest,
    ParameterRow,
    ParametersResult,
    Publication,
    SetResult,
)
from graph.inner_states import LevelResult, TransitionResult
from graph.observer import requests as of
from graph.observer.requests import Request
from tests.tui.recorded_lesson import NOW_S, lesson_update

T = TypeVar("T")

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
    wanted: Interest = field(default_factory=Interest)
    requests: list[Request[Any]] = field(default_factory=list)
    stopped: bool = False
    publish_error: Exception | None = None
    """Set: every publishing fails by this."""
    answers: dict[str, CallResult] = field(default_factory=dict)
    """Service to answer, in place of a sum of 1."""
    hold_calls: bool = False
    """Set: calls are not answered until the test sets the futures of `waiting`."""
    waiting: list[Future[CallResult]] = field(default_factory=list)
    node_parameters: dict[str, ParametersResult] = field(default_factory=dict)
    """Node to what it says of its parameters; others have `PARAMETERS`."""
    refusals: dict[str, str] = field(default_factory=dict)
    """Parameter to the reason why it is not set; node to why its log level cannot be read."""
    outcomes: Mapping[str, TransitionResult] = field(default_factory=dict)
    """Transition to what becomes of it, in place of `active`."""
    levels: dict[str, str] = field(default_factory=dict)
    """Node to its log level, in place of info."""
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

    def want(self, interest: Interest) -> None:
        self.wanted = interest

    def asked(self, kind: type[Request[Any]]) -> list[tuple[Any, ...]]:
        """The fields of all requests of this kind, oldest first."""
        return [tuple(vars(request).values()) for request in self.requests if isinstance(request, kind)]

    def ask(self, request: Request[T]) -> Future[T]:
        self.requests.append(request)
        if isinstance(request, of.CallService) and self.hold_calls:
            self.waiting.append(Future())
            return self.waiting[-1]  # type: ignore[return-value]
        if isinstance(request, (of.Publish, of.StartPublishing, of.Hold, of.SendGoal)) and self.publish_error:
            return done(None, self.publish_error)
        answer = _ANSWERS.get(type(request))
        return done(None if answer is None else answer(self, request))

    def change_goal(self, number: int, **more: Any) -> None:
        """Let a goal that was sent be otherwise: its status, feedback, result."""
        self.change(goals=tuple(replace(one, **more) if one.number == number else one for one in self.now.goals))

    @property
    def now(self) -> GraphUpdate:
        return self.update or GraphUpdate(NOW_S)

    def change(self, **more: Any) -> None:
        self.show(replace(self.now, **more))


def _start_publishing(graph: RecordedGraph, request: of.StartPublishing) -> int:
    number = len(graph.asked(of.StartPublishing))
    one = Publication(number, request.topic, request.type_name, request.hz, 0, 1)
    graph.change(publications=(*graph.now.publications, one))
    return number


def _stop_publishing(graph: RecordedGraph, request: of.StopPublishing) -> None:
    graph.change(publications=tuple(one for one in graph.now.publications if one.number != request.number))


def _stop_all(graph: RecordedGraph, _request: of.StopPublishingAll) -> None:
    if graph.now.publications:
        graph.change(publications=())


def _send_goal(graph: RecordedGraph, request: of.SendGoal) -> int:
    number = len(graph.asked(of.SendGoal))
    one = Goal(number, request.action, request.type_name, GoalStatus.SENDING, request.goal)
    graph.change(goals=(*graph.now.goals, one))
    return number


def _forget_goal(graph: RecordedGraph, request: of.ForgetGoal) -> None:
    graph.change(goals=tuple(one for one in graph.now.goals if one.number != request.number))


def _call(graph: RecordedGraph, request: of.CallService) -> CallResult:
    return graph.answers.get(request.service, CallResult(request.service, True, {"sum": 1}, "", 0.012))


def _parameters(graph: RecordedGraph, request: of.ReadParameters | of.SetParameters) -> ParametersResult:
    return graph.node_parameters.get(request.node, ParametersResult(request.node, PARAMETERS, "", 0.01))


def _set_parameters(graph: RecordedGraph, request: of.SetParameters) -> SetResult:
    refused = {name: why for name, why in graph.refusals.items() if name in request.values}
    known = _parameters(graph, request)
    taken = {name: value for name, value in request.values.items() if name not in refused}
    rows = tuple(replace(row, value=taken.get(row.name, row.value)) for row in known.parameters)
    graph.node_parameters[request.node] = replace(known, parameters=rows)
    return SetResult(request.node, refused, "", 0.01)


def _change_state(graph: RecordedGraph, request: of.ChangeState) -> TransitionResult:
    made = TransitionResult(request.node, request.transition, "active")
    return graph.outcomes.get(request.transition, made)


def _log_level(graph: RecordedGraph, request: of.LogLevel) -> LevelResult:
    if request.level is not None:
        graph.levels[request.node] = request.level
    refused = graph.refusals.get(request.node, "")
    level = "" if refused else graph.levels.get(request.node, "info")
    return LevelResult(request.node, level, refused)


_ANSWERS: Mapping[type[Request[Any]], Callable[[RecordedGraph, Any], Any]] = {
    of.Publish: lambda _graph, _request: 1,
    of.Hold: lambda _graph, _request: 1,
    of.StartPublishing: _start_publishing,
    of.StopPublishing: _stop_publishing,
    of.StopPublishingAll: _stop_all,
    of.SendGoal: _send_goal,
    of.ForgetGoal: _forget_goal,
    of.CallService: _call,
    of.ReadParameters: _parameters,
    of.SetParameters: _set_parameters,
    of.ChangeState: _change_state,
    of.LogLevel: _log_level,
}
