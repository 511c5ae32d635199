"""The actions of the dialog that publishes messages."""

from __future__ import annotations

from typing import TYPE_CHECKING

from text.i18n import N_
from tui.actions.action import Announce, actions_of

if TYPE_CHECKING:
    from tui.topics.publish import PublishDialog

action: Announce[PublishDialog] = Announce()


@action(
    "publish.once",
    "ctrl+s",
    N_("Once"),
    N_("Publish the message once, if nothing is wrong with it."),
    means="submit",
    footer=True,
    priority=True,
    palette=False,
)
def publish_message(dialog: PublishDialog) -> None:
    dialog.publish_once()


@action(
    "publish.rate",
    "ctrl+g",
    N_("At a rate"),
    N_("Publish the message repeatedly, at this rate."),
    footer=True,
    priority=True,
    palette=False,
)
def publish_at_rate(dialog: PublishDialog) -> None:
    dialog.publish_at_rate()


@action(
    "publish.stop",
    "f12",
    N_("Stop it"),
    N_("Stop publishing the selected one; Enter in the list does the same."),
    means="stop",
    footer=True,
    priority=True,
    palette=False,
    when=lambda dialog: dialog.is_publishing,
)
def stop_publication(dialog: PublishDialog) -> None:
    dialog.stop_chosen()


@action(
    "publish.take",
    "ctrl+t",
    N_("From message"),
    N_("Fill the form with the newest message of the topic."),
    means="begin with what is there",
    footer=True,
    priority=True,
    palette=False,
    when=lambda dialog: dialog.newest is not None,
)
def take_message(dialog: PublishDialog) -> None:
    dialog.take_message()


@action(
    "publish.leave",
    "escape",
    N_("Close"),
    N_("Go back to the topics; what is published at a rate goes on."),
    footer=True,
    palette=False,
)
def leave_publish(dialog: PublishDialog) -> None:
    dialog.leave()


PUBLISH_ACTIONS = actions_of(__name__)
