"""The actions of the composer."""

from __future__ import annotations

from typing import TYPE_CHECKING

from text.i18n import N_
from tui.actions.action import Announce, actions_of

if TYPE_CHECKING:
    from tui.composer.screen import ComposerScreen

action: Announce[ComposerScreen] = Announce()


def _is_not_asking(screen: ComposerScreen) -> bool | None:
    """Not while an answer is under way."""
    return not screen.is_asking


def _is_live(screen: ComposerScreen) -> bool:
    """Not in a replay."""
    return screen.feed.replay is None


@action(
    "composer.send",
    "ctrl+s",
    N_("Send"),
    N_("Send the JSON to /llm_raw_json, if nothing is wrong with it."),
    means="submit",
    footer=True,
    priority=True,
    when=_is_not_asking,
    shown=_is_live,
)
def send(screen: ComposerScreen) -> None:
    screen.send()


@action(
    "composer.send_anyway",
    "ctrl+o",
    N_("Send anyway"),
    N_("Send it although it is wrong, to see llm_parser refuse it."),
    footer=True,
    priority=True,
    when=lambda screen: bool(screen.problems),
    shown=_is_live,
)
def send_anyway(screen: ComposerScreen) -> None:
    screen.send(anyway=True)


@action(
    "composer.write",
    "enter",
    N_("Edit the JSON"),
    N_("Put the cursor into the JSON: from there on keys are typed, until Escape."),
    footer=True,
    palette=False,
    when=lambda screen: not screen.is_writing,
)
def write(screen: ComposerScreen) -> None:
    screen.draft.editor.focus()


@action(
    "composer.leave",
    "escape",
    N_("Leave the field"),
    N_("Take the cursor out of the text field: digits and letters are keys again."),
    footer=True,
    priority=True,
    palette=False,
    when=lambda screen: screen.is_writing and not screen.is_asking,
)
def leave(screen: ComposerScreen) -> None:
    screen.set_focus(None)


@action(
    "composer.ask",
    "alt+q",
    N_("Ask"),
    N_("Go to the line in which you say in words what the robot should do."),
    footer=True,
    priority=True,
    when=_is_not_asking,
)
def ask(screen: ComposerScreen) -> None:
    screen.draft.line.field.focus()


@action(
    "composer.stop_asking",
    "escape",
    N_("Take back"),
    N_("Take the question back: hang up on the model, and bring the text back."),
    footer=True,
    priority=True,
    palette=False,
    when=lambda screen: screen.is_asking,
)
def stop_asking(screen: ComposerScreen) -> None:
    screen.draft.cancel()


@action(
    "composer.auto",
    "alt+a",
    N_("Auto"),
    N_("Send valid answers of the model by themselves, until the emergency stop."),
    footer=True,
    priority=True,
    shown=_is_live,
    label=lambda screen: N_("Auto off") if screen.draft.auto else N_("Auto"),
)
def auto(screen: ComposerScreen) -> None:
    screen.draft.toggle_auto()


@action(
    "composer.prompt",
    "alt+p",
    N_("Prompt"),
    N_("Show the prompt that went out to the model, word for word."),
    footer=True,
    priority=True,
)
def show_prompt(screen: ComposerScreen) -> None:
    screen.show_prompt()


@action(
    "composer.templates",
    "ctrl+t",
    N_("Templates"),
    N_("Start from an example, valid or invalid."),
    means="begin with what is there",
    footer=True,
    priority=True,
    anywhere=True,
    when=_is_not_asking,
)
def templates(screen: ComposerScreen) -> None:
    screen.choose_template()


@action(
    "composer.older",
    "alt+up,ctrl+up",
    N_("Older"),
    N_("Bring back what was sent before."),
    footer=True,
    priority=True,
    when=_is_not_asking,
)
def older_sent(screen: ComposerScreen) -> None:
    screen.recall(-1)


@action(
    "composer.newer",
    "alt+down,ctrl+down",
    N_("Newer"),
    N_("Go back towards what you were writing."),
    priority=True,
    when=_is_not_asking,
)
def newer_sent(screen: ComposerScreen) -> None:
    screen.recall(1)


@action(
    "composer.next_problem",
    "ctrl+n",
    N_("Next problem"),
    N_("Move the cursor to the next problem."),
    priority=True,
    anywhere=True,
    when=lambda screen: bool(screen.problems),
)
def next_problem(screen: ComposerScreen) -> None:
    screen.draft.go_to_next_problem()


COMPOSER_ACTIONS = actions_of(__name__)
