"""What a recording cannot do: whoever asks gets a word, never silence."""

from __future__ import annotations

from concurrent.futures import Future
from typing import TYPE_CHECKING, TypeVar

from graph.data import CallResult, ParametersResult, SetResult
from graph.observer.requests import ObserverError
from graph.words import say

if TYPE_CHECKING:
    from collections.abc import Mapping

    from graph.data import Value
    from graph.publishing.dead_man_switch import Holding

T = TypeVar("T")


class Refusals:
    """The half of a `GraphLink` that would change something: all of it fails at once."""

    def prepare_publisher(
        self, topic: str, type_name: str, *, latched: bool = False
    ) -> Future[None]:
        """Fail."""
        del topic, type_name, latched
        return _failed()

    def publish(
        self, topic: str, type_name: str, value: Mapping[str, Value], *, latched: bool = False
    ) -> Future[int]:
        """Fail."""
        del topic, type_name, value, latched
        return _failed()

    def start_publishing(
        self, topic: str, type_name: str, value: Mapping[str, Value], hz: float
    ) -> Future[int]:
        """Fail."""
        del topic, type_name, value, hz
        return _failed()

    def stop_publishing(self, number: int) -> None:
        """Do nothing: nothing is published."""

    def stop_publishing_all(self) -> None:
        """Do nothing: nothing is published."""

    def prepare_hold(self, topic: str, type_name: str) -> Future[None]:
        """Fail."""
        del topic, type_name
        return _failed()

    def hold(self, topic: str, type_name: str, word: Holding) -> Future[int]:
        """Fail."""
        del topic, type_name, word
        return _failed()

    def let_go(self, topic: str) -> None:
        """Do nothing: nothing is held."""

    def call(
        self, service: str, type_name: str, request: Mapping[str, Value], timeout_s: float = 5.0
    ) -> Future[CallResult]:
        """Answer that there is nobody to answer."""
        del type_name, request, timeout_s
        return _done(CallResult(service, False, None, _words(), 0.0))

    def parameters(self, node: str, timeout_s: float = 5.0) -> Future[ParametersResult]:
        """Answer that there is nobody to ask."""
        del timeout_s
        return _done(ParametersResult(node, error=_words()))

    def set_parameters(
        self, node: str, values: Mapping[str, Value], timeout_s: float = 5.0
    ) -> Future[SetResult]:
        """Answer that there is nobody to tell."""
        del values, timeout_s
        return _done(SetResult(node, error=_words()))

    def send_goal(self, action: str, type_name: str, goal: Mapping[str, Value]) -> Future[int]:
        """Fail."""
        del action, type_name, goal
        return _failed()

    def cancel_goal(self, number: int) -> None:
        """Do nothing: there is no goal."""

    def cancel_seen_goal(self, action: str, goal_id: str) -> None:
        """Do nothing: there is no goal."""

    def forget_goal(self, number: int) -> None:
        """Do nothing: there is no goal."""


def _words() -> str:
    return say("this is a recording: nobody can hear it")


def _failed() -> Future[T]:
    future: Future[T] = Future()
    future.set_exception(ObserverError(_words()))
    return future


def _done(result: T) -> Future[T]:
    future: Future[T] = Future()
    future.set_result(result)
    return future
