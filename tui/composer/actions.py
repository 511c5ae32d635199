"""The actions of the composer."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from text.i18n import N_
from tui.actions.action import Action

if TYPE_CHECKING:
    from collections.abc import Sequence

    from tui.session.feed import Feed


class ComposerTarget(Protocol):
    """The part of the composer that its actions use."""

    @property
    def feed(self) -> Feed:
        """The session."""

    @property
    def problems(self) -> Sequence[object]:
        """The problems in the JSON."""

    @property
    def is_asking(self) -> bool:
        """Whether an answer of a model is under way."""

    @property
    def is_writing(self) -> bool:
        """Whether the cursor stands in a text field."""

    def write(self) -> None:
        """Put the cursor into the JSON."""

    def leave(self) -> None:
        """Take the cursor out of the text field."""

    @property
    def is_auto(self) -> bool:
        """Whether a valid answer is sent by itself."""

    def send(self, *, anyway: bool = False) -> bool:
        """Send the JSON; with `anyway` even if it is invalid."""

    def go_to_line(self) -> None:
        """Go to the line in which a model is asked."""

    def toggle_auto(self) -> None:
        """Send valid answers by themselves from now on, or no longer."""

    def compare(self) -> None:
        """Ask two models the same."""

    def show_prompt(self) -> None:
        """Show what was sent to the model."""

    def stop_asking(self) -> None:
        """Hang up on the model."""

    def choose_template(self) -> None:
        """Ask for an example to start from."""

    def recall(self, *, older: bool) -> None:
        """Recall the JSON that was sent before this one, or after it."""

    def go_to_next_problem(self) -> None:
        """Move the cursor to the next problem."""


class ComposerAction(Action[ComposerTarget]):
    """An action of the composer; its key takes precedence over the editor's."""

    priority = True


class _SendAction(ComposerAction):
    """An action that needs a robot; without one the screen says why nothing is sent."""

    @classmethod
    def shown(cls, target: ComposerTarget) -> bool:
        """Not in a replay."""
        return target.feed.replay is None

    @classmethod
    def possible(cls, target: ComposerTarget) -> bool | None:
        """Not while an answer is under way."""
        return not target.is_asking


class Send(_SendAction):
    """Send the JSON."""

    id = "composer.send"
    key = "ctrl+s"
    title = N_("Send")
    means = "submit"
    tooltip = N_("Send the JSON to /llm_raw_json, if nothing is wrong with it.")
    footer = True

    @classmethod
    async def run(cls, target: ComposerTarget) -> None:
        target.send()


class SendAnyway(_SendAction):
    """Send invalid JSON, to see it refused."""

    id = "composer.send_anyway"
    key = "ctrl+o"
    title = N_("Send anyway")
    tooltip = N_("Send it although it is wrong, to see llm_parser refuse it.")
    footer = True

    @classmethod
    def possible(cls, target: ComposerTarget) -> bool | None:
        """Only if the JSON is invalid; that of an answer under way is not known to be."""
        return bool(target.problems)

    @classmethod
    async def run(cls, target: ComposerTarget) -> None:
        target.send(anyway=True)


class Write(Action[ComposerTarget]):
    """Go into the editor."""

    id = "composer.write"
    key = "enter"
    title = N_("Edit the JSON")
    tooltip = N_("Put the cursor into the JSON: from there on keys are typed, until Escape.")
    footer = True
    palette = False

    @classmethod
    def possible(cls, target: ComposerTarget) -> bool | None:
        """Only outside of the text fields."""
        return not target.is_writing

    @classmethod
    async def run(cls, target: ComposerTarget) -> None:
        target.write()


class Leave(ComposerAction):
    """Come out of the editor."""

    id = "composer.leave"
    key = "escape"
    title = N_("Leave the field")
    tooltip = N_("Take the cursor out of the text field: digits and letters are keys again.")
    footer = True
    palette = False

    @classmethod
    def possible(cls, target: ComposerTarget) -> bool | None:
        """Only in a text field; while a model answers, the key takes the question back."""
        return target.is_writing and not target.is_asking

    @classmethod
    async def run(cls, target: ComposerTarget) -> None:
        target.leave()


class _WritingAction(ComposerAction):
    """An action that changes the text."""

    @classmethod
    def possible(cls, target: ComposerTarget) -> bool | None:
        """Not while an answer is under way."""
        return not target.is_asking


class Ask(ComposerAction):
    """Say in words what the robot should do."""

    id = "composer.ask"
    key = "alt+q,alt+й"
    title = N_("Ask")
    tooltip = N_("Go to the line in which you say in words what the robot should do.")
    footer = True

    @classmethod
    def possible(cls, target: ComposerTarget) -> bool | None:
        """Not while an answer is under way."""
        return not target.is_asking

    @classmethod
    async def run(cls, target: ComposerTarget) -> None:
        target.go_to_line()


class StopAsking(ComposerAction):
    """Hang up on the model."""

    id = "composer.stop_asking"
    key = "escape"
    title = N_("Take back")
    tooltip = N_("Take the question back: hang up on the model, and bring the text back.")
    footer = True
    palette = False

    @classmethod
    def possible(cls, target: ComposerTarget) -> bool | None:
        """Only while an answer is under way."""
        return target.is_asking

    @classmethod
    async def run(cls, target: ComposerTarget) -> None:
        target.stop_asking()


class Auto(_SendAction):
    """Send valid answers by themselves."""

    id = "composer.auto"
    key = "alt+a,alt+ф"
    title = N_("Auto")
    tooltip = N_("Send valid answers of the model by themselves, until the emergency stop.")
    footer = True

    @classmethod
    def possible(cls, target: ComposerTarget) -> bool | None:
        """Always: where it cannot be, the line says why."""
        del target
        return True

    @classmethod
    def label(cls, target: ComposerTarget) -> str:
        """Named after what it would do now."""
        return N_("Auto off") if target.is_auto else cls.title

    @classmethod
    async def run(cls, target: ComposerTarget) -> None:
        target.toggle_auto()


class Compare(ComposerAction):
    """Ask two models the same."""

    id = "composer.compare"
    key = "alt+c,alt+с"
    title = N_("Compare")
    tooltip = N_("Ask two models the same words, and see both answers side by side.")
    footer = True

    @classmethod
    def possible(cls, target: ComposerTarget) -> bool | None:
        """Not while an answer is under way."""
        return not target.is_asking

    @classmethod
    async def run(cls, target: ComposerTarget) -> None:
        target.compare()


class ShowPrompt(ComposerAction):
    """Look at what was sent to the model."""

    id = "composer.prompt"
    key = "alt+p,alt+з"
    title = N_("Prompt")
    tooltip = N_("Show the prompt that went out to the model, word for word.")
    footer = True

    @classmethod
    async def run(cls, target: ComposerTarget) -> None:
        target.show_prompt()


class Templates(_WritingAction):
    """Start from an example."""

    id = "composer.templates"
    key = "ctrl+t"
    title = N_("Templates")
    means = "begin with what is there"
    tooltip = N_("Start from an example, valid or invalid.")
    footer = True
    from_elsewhere = True

    @classmethod
    async def run(cls, target: ComposerTarget) -> None:
        target.choose_template()


class OlderSent(_WritingAction):
    """Recall the text sent before this one."""

    id = "composer.older"
    key = "alt+up,ctrl+up"
    title = N_("Older")
    tooltip = N_("Bring back what was sent before.")
    footer = True

    @classmethod
    async def run(cls, target: ComposerTarget) -> None:
        target.recall(older=True)


class NewerSent(_WritingAction):
    """Go back towards the text being written."""

    id = "composer.newer"
    key = "alt+down,ctrl+down"
    title = N_("Newer")
    tooltip = N_("Go back towards what you were writing.")

    @classmethod
    async def run(cls, target: ComposerTarget) -> None:
        target.recall(older=False)


class NextProblem(ComposerAction):
    """Go to the next problem."""

    id = "composer.next_problem"
    key = "ctrl+n"
    title = N_("Next problem")
    tooltip = N_("Move the cursor to the next problem.")
    from_elsewhere = True

    @classmethod
    def possible(cls, target: ComposerTarget) -> bool | None:
        """Only if there is one."""
        return bool(target.problems)

    @classmethod
    async def run(cls, target: ComposerTarget) -> None:
        target.go_to_next_problem()


COMPOSER_ACTIONS = (
    Write,
    Leave,
    Send,
    SendAnyway,
    Ask,
    StopAsking,
    Auto,
    Compare,
    ShowPrompt,
    Templates,
    OlderSent,
    NewerSent,
    NextProblem,
)
