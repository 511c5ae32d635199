"""/brain_state: what the brain does, with which model, and what that takes; beside /safety_state.

A status named after the node: OK while it thinks and answers, WARN by its rules, ERROR if a model
that is set up gave no answer. The values are for programs; what is unknown is empty.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue

from nodes.parts.qos import DEPTH
from robot.topics import BRAIN_STATE
from text.i18n import N_

if TYPE_CHECKING:
    from brain.budget import TokenUsage
    from brain.faults import ModelError
    from nodes.parts.node import LessonNode
    from nodes.thinking.model import AskedModel

_EVERY_S = 1.0
_RULES = N_("follows its rules")
_WAITS = N_("waits for a voice; {model}")
_THINKS = N_("thinks; {model}")
_ANSWERED = N_("has answered; {model}")


class BrainState:
    """Publishes at each change, and once a second."""

    def __init__(self, node: LessonNode, model: AskedModel | None) -> None:
        self._node, self._model = node, model
        self._status = DiagnosticStatus(name=str(node.get_name()))
        self._usage: TokenUsage | None = None
        self._fault = ""
        self._publisher = node.create_publisher(DiagnosticArray, BRAIN_STATE, DEPTH)
        if model is None:
            self._say(DiagnosticStatus.WARN, _RULES)
        else:
            self.waits()
        node.every(_EVERY_S, self._publish)

    def waits(self) -> None:
        """Nothing is under way."""
        self._say(DiagnosticStatus.OK, _WAITS)

    def thinks(self) -> None:
        """A question is under way."""
        self._say(DiagnosticStatus.OK, _THINKS)

    def answered(self, usage: TokenUsage) -> None:
        self._usage, self._fault = usage, ""
        self._say(DiagnosticStatus.OK, _ANSWERED)

    def failed(self, error: ModelError) -> None:
        """There is no answer, and the robot stands."""
        self._fault = error.kind.value
        self._say(DiagnosticStatus.ERROR, str(error.words.template), **error.words.values)

    def _say(self, level: bytes, phrase: str, **values: object) -> None:
        name = self._model.name if self._model is not None else ""
        self._status.level = level
        self._status.message = self._node.say.text(phrase, **{"model": name, **values})
        self._publish()

    def _publish(self) -> None:
        self._status.values = [KeyValue(key=key, value=value) for key, value in self._values()]
        message = DiagnosticArray(status=[self._status])
        message.header.stamp = self._node.get_clock().now().to_msg()
        self._publisher.publish(message)

    def _values(self) -> list[tuple[str, str]]:
        model, usage = self._model, self._usage
        values = [("backend", "rules" if model is None else "llm"), ("fault", self._fault)]
        if model is None:
            return values
        totals, budget = model.ledger.totals(), model.settings.budget
        values += [
            ("model", model.name),
            ("calls_last_minute", str(totals.calls_last_minute)),
            ("calls_per_minute", str(budget.calls_per_minute)),
            ("tokens", str(totals.tokens)),
            ("tokens_per_session", str(budget.tokens_per_session)),
        ]
        if usage is not None:
            prices = model.settings.prices
            cost = usage.cost(prices)
            values += [
                ("input_tokens", str(usage.input_tokens)),
                ("output_tokens", str(usage.output_tokens)),
                ("first_token_s", f"{usage.first_token_s:.3f}"),
                ("total_s", f"{usage.total_s:.3f}"),
                ("cost", "" if cost is None else f"{cost:.6f}"),
                ("currency", "" if prices is None else prices.currency),
            ]
        return values
