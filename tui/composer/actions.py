"""What can be done in the composer."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from text.i18n import N_
from tui.actions.action import Action

if TYPE_CHECKING:
    from collections.abc import Sequence

    from tui.session.feed import Feed


class ComposerTarget(Protocol):
    """What these actions need of the composer."""

    @property
    def feed(self) -> Feed:
        """What runs."""

    @property
    def problems(self) -> Sequence[object]:
        """What is wrong with the JSON."""

    def send(self, *, anyway: bool = False) -> None:
        """Send the JSON, `anyway` though it is wrong."""

    def choose_template(self) -> None:
        """Ask which example to begin with."""

    def recall(self, *, older: bool) -> None:
        """Take the JSON that was sent before this one, or after it."""

    def go_to_next_problem(self) -> None:
        """Put the cursor to the next problem."""


class ComposerAction(Action[ComposerTarget]):
    """Something that the composer does; it comes before what the editor would take the key for."""

    priority = True


class _SendAction(ComposerAction):
    """Something that needs a robot; without one the screen tells why nothing is sent."""

    @classmethod
    def shown(cls, target: ComposerTarget) -> bool:
        """Not beside a recording."""
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
        """Send what is valid."""
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
        """Only what is wrong."""
        return bool(target.problems)

    @classmethod
    async def run(cls, target: ComposerTarget) -> None:
        """Send it as it is."""
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
        """Choose one."""
        target.choose_template()


class OlderSent(ComposerAction):
    """What was sent before."""

    id = "composer.older"
    key = "alt+up,ctrl+up"
    title = N_("Older")
    tooltip = N_("Bring back what was sent before.")
    footer = True

    @classmethod
    async def run(cls, target: ComposerTarget) -> None:
        """Recall it."""
        target.recall(older=True)


class NewerSent(ComposerAction):
    """Back towards what was being written."""

    id = "composer.newer"
    key = "alt+down,ctrl+down"
    title = N_("Newer")
    tooltip = N_("Go back towards what you were writing.")

    @classmethod
    async def run(cls, target: ComposerTarget) -> None:
        """Recall it."""
        target.recall(older=False)


class NextProblem(ComposerAction):
    """Go to the next problem."""

    id = "composer.next_problem"
    key = "ctrl+n"
    title = N_("Next problem")
    tooltip = N_("Put the cursor where the next thing is wrong.")
    from_elsewhere = True

    @classmethod
    def possible(cls, target: ComposerTarget) -> bool | None:
        """Only if something is."""
        return bool(target.problems)

    @classmethod
    async def run(cls, target: ComposerTarget) -> None:
        """Go there."""
        target.go_to_next_problem()


COMPOSER_ACTIONS = (Send, SendAnyway, Templates, OlderSent, NewerSent, NextProblem)
