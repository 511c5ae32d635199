"""The actions of the dialog that publishes messages."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from text.i18n import N_
from tui.actions.action import Action

if TYPE_CHECKING:
    from graph.data import Sample


class PublishingTarget(Protocol):
    """The part of the dialog that its actions use."""

    @property
    def is_publishing(self) -> bool:
        """Whether anything is being published."""

    @property
    def newest(self) -> Sample | None:
        """The newest message of the topic that was entered."""

    def publish_once(self) -> None:
        """Publish the message."""

    def publish_at_rate(self) -> None:
        """Publish the message periodically."""

    def stop_chosen(self) -> None:
        """Stop the chosen publication."""

    def take_message(self) -> None:
        """Fill the form with the newest message."""

    def leave(self) -> None:
        """Close the list of types if it is open, otherwise the dialog."""


class PublishAction(Action[PublishingTarget]):
    """An action of the dialog; its key takes precedence over a text field's."""

    priority = True
    palette = False
    footer = True


class PublishMessage(PublishAction):
    """Publish the message once."""

    id = "publish.once"
    key = "ctrl+s"
    title = N_("Once")
    means = "submit"
    tooltip = N_("Publish the message once, if nothing is wrong with it.")

    @classmethod
    async def run(cls, target: PublishingTarget) -> None:
        target.publish_once()


class PublishAtRate(PublishAction):
    """Publish the message periodically."""

    id = "publish.rate"
    key = "ctrl+g"
    title = N_("At a rate")
    tooltip = N_("Publish the message repeatedly, at this rate.")

    @classmethod
    async def run(cls, target: PublishingTarget) -> None:
        target.publish_at_rate()


class StopPublication(PublishAction):
    """Stop a publication."""

    id = "publish.stop"
    key = "f12"
    title = N_("Stop it")
    means = "stop"
    tooltip = N_("Stop publishing the selected one; Enter in the list does the same.")

    @classmethod
    def possible(cls, target: PublishingTarget) -> bool | None:
        """Only if something is being published."""
        return target.is_publishing

    @classmethod
    async def run(cls, target: PublishingTarget) -> None:
        target.stop_chosen()


class TakeMessage(PublishAction):
    """Copy a received message, to be changed and sent."""

    id = "publish.take"
    key = "ctrl+t"
    title = N_("From message")
    means = "begin with what is there"
    tooltip = N_("Fill the form with the newest message of the topic.")

    @classmethod
    def possible(cls, target: PublishingTarget) -> bool | None:
        """Only if there is one."""
        return target.newest is not None

    @classmethod
    async def run(cls, target: PublishingTarget) -> None:
        target.take_message()


class LeavePublish(PublishAction):
    """Go back to the topics."""

    id = "publish.leave"
    key = "escape"
    title = N_("Close")
    tooltip = N_("Go back to the topics; what is published at a rate goes on.")
    priority = False

    @classmethod
    async def run(cls, target: PublishingTarget) -> None:
        """Close the list of types, or the dialog."""
        target.leave()


PUBLISH_ACTIONS = (PublishMessage, PublishAtRate, StopPublication, TakeMessage, LeavePublish)
