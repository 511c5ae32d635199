"""The brain's model: from a situation to an answer, with the talk so far, in words on the log."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from brain.prompt import prompt_file, read_prompt
from brain.situation import Memory, Situation, conversation
from nodes.parts.node import LessonNode
from nodes.thinking.model import AskedModel, BrainState
from robot.commands.schema import SpokenResponse, parse_llm
from text.i18n import N_

if TYPE_CHECKING:
    from brain.budget import TokenUsage
    from brain.faults import ModelError
    from brain.ladder import Ladder
    from brain.settings import ModelSettings
    from brain.thinking import Thought

_ASKED = N_("Asking {model}")
_REPAIRED = N_("{model} answered something invalid, and is asked once more: {problem}")
_USED = N_("{model}: {tokens_in} + {tokens_out} tokens, the first after {first:.2f} s, all {total:.2f} s")
_COST = N_("That was {cost:.5f} {currency}")


class ModelMind:
    """Thinks about one situation at a time."""

    def __init__(
        self,
        node: LessonNode,
        answered: Callable[[SpokenResponse], None],
        failed: Callable[[ModelError, Situation], None],
    ) -> None:
        """The node has the settings `prompt` and `picture`.

        Raises:
            ModelError: if no model is set up, or not rightly.
        """
        self._node = node
        self.model = AskedModel(node, self._name)
        self.state = BrainState(node, self.model)
        self._say = node.say
        self._answered, self._failed = answered, failed
        self._memory = Memory()

    @property
    def sees(self) -> bool:
        return self._sees(self.model.settings)

    def think(self, situation: Situation) -> None:
        """Think about this, in place of what is being thought about."""
        self._say.info(_ASKED, model=self.model.name)
        self.state.thinks()
        self.model.ask(
            lambda ladder: self._question(ladder, situation),
            lambda thought: self._take(thought, situation),
            lambda error: self._fail(error, situation),
        )

    def stop(self) -> None:
        if self.model.busy:
            self.model.cancel()
            self.state.waits()

    def close(self) -> None:
        self.model.close()

    def _sees(self, settings: ModelSettings) -> bool:
        wish = self._node.values["picture"]
        return wish == "sent" or (wish == "auto" and settings.vision_model is not None)

    def _name(self, settings: ModelSettings) -> str:
        return (self._sees(settings) and settings.vision_model) or settings.model

    async def _question(self, ladder: Ladder, situation: Situation) -> Thought[SpokenResponse]:
        from brain.thinking import think

        prompt = read_prompt(prompt_file(self._node.values["prompt"], "brain", self._say.language))
        return await think(
            ladder,
            SpokenResponse.model_json_schema(),
            conversation(prompt, self._memory, situation),
            lambda text: parse_llm(text, SpokenResponse),
            on_repair=lambda problem: self.model.later(lambda: self._repaired(problem)),
        )

    def _repaired(self, problem: str) -> None:
        self._say.warn(_REPAIRED, model=self.model.name, problem=problem)

    def _take(self, thought: Thought[SpokenResponse], situation: Situation) -> None:
        self._answered(thought.value)
        self._memory.add(situation.heard, thought.text)
        self._tell(thought.usages[-1])
        self.state.answered(thought.usages[-1])

    def _tell(self, usage: TokenUsage) -> None:
        self._say.info(
            _USED,
            model=usage.model,
            tokens_in=usage.input_tokens,
            tokens_out=usage.output_tokens,
            first=usage.first_token_s,
            total=usage.total_s,
        )
        prices = self.model.settings.prices
        if prices is not None:
            self._say.info(_COST, cost=usage.cost(prices), currency=prices.currency)

    def _fail(self, error: ModelError, situation: Situation) -> None:
        self.state.failed(error)
        self._failed(error, situation)
