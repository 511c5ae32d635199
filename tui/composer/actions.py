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

    def send(self, *, anyway: bool = False) -> None:
        """Send the JSON; with `anyway` even if it is invalid."""

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
        """Send it if it is valid."""
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
        """Only if the JSON is invalid."""
        return bool(target.problems)

    @classmethod
    async def run(cls, target: ComposerTarget) -> None:
        """Send it unchanged."""
        target.send(anyway=True)


class Templates(ComposerAction):
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
        """Open the dialog."""
        target.choose_template()


class OlderSent(ComposerAction):
    """Recall the text sent before this one."""

    id = "composer.older"
    key = "alt+up,ctrl+up"
    title = N_("Older")
    tooltip = N_("Bring back what was sent before.")
    footer = True

    @classmethod
    async def run(cls, target: ComposerTarget) -> None:
        """Recall the older text."""
        target.recall(older=True)


class NewerSent(ComposerAction):
    """Go back towards the text being written."""

    id = "composer.newer"
    key = "alt+down,ctrl+down"
    title = N_("Newer")
    tooltip = N_("Go back towards what you were writing.")

    @classmethod
    async def run(cls, target: ComposerTarget) -> None:
        """Recall the newer text."""
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
        """Go there."""
        target.go_to_next_problem()


COMPOSER_ACTIONS = (Send, SendAnyway, Templates, OlderSent, NewerSent, NextProblem)
