"""What can be done about publishing messages: the dialog opened, and what it can do."""

from __future__ import annotations

from typing import TYPE_CHECKING

from text.i18n import N_
from tui.actions.action import Action
from tui.topics.actions import TopicsAction

if TYPE_CHECKING:
    from tui.topics.publish import PublishDialog
    from tui.topics.screen import TopicsScreen


class OpenPublish(TopicsAction):
    """A message of one's own."""

    id = "topics.publish"
    key = "P,З"
    title = N_("Publish")
    tooltip = N_("Publish a message to the chosen topic or to a new one, once or at a rate.")
    footer = True

    @classmethod
    def possible(cls, target: TopicsScreen) -> bool | None:
        """Only while there is a graph to publish in: a recording takes nothing."""
        return target.feed.graph is not None and target.feed.replay is None

    @classmethod
    async def run(cls, target: TopicsScreen) -> None:
        """Open the dialog over the screen."""
        from tui.topics.publish import open_publish

        open_publish(target)


class PublishAction(Action["PublishDialog"]):
    """Something that the dialog does; it comes before what a text field would take the key for."""

    priority = True
    palette = False
    footer = True


class PublishOnce(PublishAction):
    """The message, once."""

    id = "publish.once"
    key = "ctrl+s"
    title = N_("Once")
    means = "submit"
    tooltip = N_("Publish the message once, if nothing is wrong with it.")

    @classmethod
    async def run(cls, target: PublishDialog) -> None:
        """Publish."""
        target.publish_once()


class PublishAtRate(PublishAction):
    """The message, again and again."""

    id = "publish.rate"
    key = "ctrl+g"
    title = N_("At a rate")
    tooltip = N_("Publish the message again and again, so many times a second.")

    @classmethod
    async def run(cls, target: PublishDialog) -> None:
        """Begin."""
        target.publish_at_rate()


class StopPublication(PublishAction):
    """No more of it."""

    id = "publish.stop"
    key = "f12"
    title = N_("Stop it")
    means = "stop"
    tooltip = N_("Stop publishing the chosen one; Enter in the list does the same.")

    @classmethod
    def possible(cls, target: PublishDialog) -> bool | None:
        """Only if something is being published."""
        return target.is_publishing

    @classmethod
    async def run(cls, target: PublishDialog) -> None:
        """Stop it."""
        target.stop_chosen()


class TakeMessage(PublishAction):
    """What came, to be changed and sent."""

    id = "publish.take"
    key = "ctrl+t"
    title = N_("From message")
    means = "begin with what is there"
    tooltip = N_("Fill the form with the newest message of the topic.")

    @classmethod
    def possible(cls, target: PublishDialog) -> bool | None:
        """Only if there is one."""
        return target.newest is not None

    @classmethod
    async def run(cls, target: PublishDialog) -> None:
        """Take it."""
        target.take_message()


class LeavePublish(PublishAction):
    """Back to the topics."""

    id = "publish.leave"
    key = "escape"
    title = N_("Close")
    tooltip = N_("Go back to the topics; what is published at a rate goes on.")
    priority = False

    @classmethod
    async def run(cls, target: PublishDialog) -> None:
        """Close the list of types, or the dialog."""
        target.leave()


PUBLISH_ACTIONS = (PublishOnce, PublishAtRate, StopPublication, TakeMessage, LeavePublish)
