"""What the observer asks single nodes about themselves: transitions, log levels."""

from __future__ import annotations

from typing import TYPE_CHECKING

from graph.calls.timeouts import ANSWER_WITHIN_S
from graph.inner_states import LevelResult, TransitionResult
from graph.observer.requests import Begin
from text.sentences import reason_of

if TYPE_CHECKING:
    from concurrent.futures import Future

    from graph.observer.requests import RequestQueue


class InnerStates:
    """Requests to one node each. All methods may be called from any thread, none blocks."""

    def __init__(self, requests: RequestQueue) -> None:
        """Queue for the observer's own thread."""
        self._requests = requests

    def change_state(
        self, node: str, transition: str, timeout_s: float = ANSWER_WITHIN_S
    ) -> Future[TransitionResult]:
        """Have a node with a lifecycle make a transition, by its name: `configure`.

        The result says what it led to, or in words why not; the future never raises. `timeout_s` is
        for every answer but that to the transition itself, which may take longer.
        """
        request = Begin[TransitionResult](
            lambda own, future: own.lifecycles.change(node, transition, timeout_s, future),
            lambda error: TransitionResult(node, transition, error=reason_of(error)),
        )
        self._requests.put(request)
        return request.future

    def logger_level(self, node: str, timeout_s: float = ANSWER_WITHIN_S) -> Future[LevelResult]:
        """Read from which severity on a node logs; the future never raises."""
        request = Begin[LevelResult](
            lambda own, future: own.logger_levels.read(node, timeout_s, future),
            lambda error: LevelResult(node, error=reason_of(error)),
        )
        self._requests.put(request)
        return request.future

    def set_logger_level(
        self, node: str, level: str, timeout_s: float = ANSWER_WITHIN_S
    ) -> Future[LevelResult]:
        """Set it to one of `graph.inner_states.LOG_LEVELS`; the future never raises."""
        request = Begin[LevelResult](
            lambda own, future: own.logger_levels.write(node, level, timeout_s, future),
            lambda error: LevelResult(node, error=reason_of(error)),
        )
        self._requests.put(request)
        return request.future
