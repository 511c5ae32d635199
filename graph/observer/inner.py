"""What the observer asks single nodes about themselves: transitions, log levels."""

from __future__ import annotations

from typing import TYPE_CHECKING

from graph.calls.timeouts import ANSWER_WITHIN_S
from graph.inner_states import LevelResult, TransitionResult
from text.sentences import reason_of

if TYPE_CHECKING:
    from concurrent.futures import Future

    from graph.observer.client import ObserverClient


class InnerStates:
    """Requests to one node each. All methods may be called from any thread, none blocks."""

    def __init__(self, client: ObserverClient) -> None:
        self._client = client

    def change_state(
        self, node: str, transition: str, timeout_s: float = ANSWER_WITHIN_S
    ) -> Future[TransitionResult]:
        """Have a node with a lifecycle make a transition, by its name: `configure`.

        The result says what it led to, or in words why not; the future never raises. `timeout_s` is
        for every answer but that to the transition itself, which may take longer.
        """
        return self._client.ask(
            "change_state",
            node,
            transition,
            timeout_s,
            refusal=lambda error: TransitionResult(node, transition, error=reason_of(error)),
        )

    def logger_level(self, node: str, timeout_s: float = ANSWER_WITHIN_S) -> Future[LevelResult]:
        """Read from which severity on a node logs; the future never raises."""
        return self._client.ask(
            "logger_level", node, timeout_s, refusal=lambda error: LevelResult(node, error=reason_of(error))
        )

    def set_logger_level(self, node: str, level: str, timeout_s: float = ANSWER_WITHIN_S) -> Future[LevelResult]:
        """Set it to one of `graph.inner_states.LOG_LEVELS`; the future never raises."""
        return self._client.ask(
            "set_logger_level",
            node,
            level,
            timeout_s,
            refusal=lambda error: LevelResult(node, error=reason_of(error)),
        )
