"""What can be done on the Flow screen; each letter also under its Cyrillic key."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from text.i18n import N_
from tui.actions.action import Action

if TYPE_CHECKING:
    from tui.flow.chains import Chain, FlowStep, Lane


class FlowTarget(Protocol):
    """What these actions need of the screen of the flow."""

    @property
    def chosen_step(self) -> FlowStep | None:
        """The step at the cursor."""

    paused: bool
    """Whether what comes is held back."""

    def neighbour(self, step: int) -> Chain | None:
        """Return the chain so many places below the chosen one."""

    def go(self, step: int) -> None:
        """Go to that chain."""

    def toggle_pause(self) -> None:
        """Hold back what comes, or show it."""

    def toggle_lane(self, lane: Lane) -> None:
        """Hide who is in this lane, or show them."""

    def show_all(self) -> None:
        """Hide nobody."""

    def toggle_logs(self) -> None:
        """Show other nodes' logs, or hide them."""

    def toggle_scale(self) -> None:
        """Draw the time by its logarithm, or as it is."""

    def copy_chain(self) -> None:
        """Copy the chosen chain."""


class FlowAction(Action[FlowTarget]):
    """Something about the timeline."""

    from_elsewhere = True


class _Chosen(FlowAction):
    """Something about the chosen step."""

    from_elsewhere = False

    @classmethod
    def possible(cls, target: FlowTarget) -> bool | None:
        """Only with a step to choose."""
        return True if target.chosen_step else None


class OlderChain(FlowAction):
    """The utterance before."""

    id = "flow.older"
    key = "n,т"
    title = N_("Older")
    means = "next"
    tooltip = N_("Go to the utterance before this one.")
    footer = True

    @classmethod
    def possible(cls, target: FlowTarget) -> bool | None:
        """Only if there is one."""
        return True if target.neighbour(1) else None

    @classmethod
    async def run(cls, target: FlowTarget) -> None:
        """Go there."""
        target.go(1)


class NewerChain(FlowAction):
    """The utterance after."""

    id = "flow.newer"
    key = "N,Т"
    title = N_("Newer")
    means = "previous"
    tooltip = N_("Go to the utterance after this one.")

    @classmethod
    def possible(cls, target: FlowTarget) -> bool | None:
        """Only if there is one."""
        return True if target.neighbour(-1) else None

    @classmethod
    async def run(cls, target: FlowTarget) -> None:
        """Go there."""
        target.go(-1)


class PauseFlow(FlowAction):
    """Hold the timeline still."""

    id = "flow.pause"
    key = "p,з"
    title = N_("Pause")
    tooltip = N_("Freeze the timeline, or show what has come since.")
    footer = True

    @classmethod
    def label(cls, target: FlowTarget) -> str:
        """By what it would do now."""
        return N_("Resume") if target.paused else cls.title

    @classmethod
    async def run(cls, target: FlowTarget) -> None:
        """Do the other of the two."""
        target.toggle_pause()


class HideLane(_Chosen):
    """Leave out what the chosen step belongs to."""

    id = "flow.hide"
    key = "m,ь"
    title = N_("Hide")
    means = "leave out"
    tooltip = N_("Leave out all steps of the chosen one's kind: microphone, brain, wheels...")
    footer = True

    @classmethod
    async def run(cls, target: FlowTarget) -> None:
        """Leave them out."""
        if target.chosen_step:
            target.toggle_lane(target.chosen_step.lane)


class ShowAllLanes(FlowAction):
    """Everything that takes part."""

    id = "flow.all"
    key = "a,ф"
    title = N_("Show all")
    means = "all"
    tooltip = N_("Show every step again, without the logs of other nodes.")
    footer = True

    @classmethod
    async def run(cls, target: FlowTarget) -> None:
        """Hide nothing."""
        target.show_all()


class OtherLogs(FlowAction):
    """What the other nodes wrote into their logs meanwhile."""

    id = "flow.logs"
    key = "u,г"
    title = N_("Other logs")
    means = "how much of the log"
    tooltip = N_("Show or hide what other nodes wrote into their logs meanwhile.")
    footer = True

    @classmethod
    async def run(cls, target: FlowTarget) -> None:
        """Show or hide it."""
        target.toggle_logs()


class ChangeTimeScale(FlowAction):
    """A linear axis, or one that spreads the beginning."""

    id = "flow.scale"
    key = "z,я"
    title = N_("Scale")
    means = "time span"
    tooltip = N_("Let the axis of time spread the first milliseconds, or be even.")
    footer = True

    @classmethod
    async def run(cls, target: FlowTarget) -> None:
        """Take the other one."""
        target.toggle_scale()


class CopyChain(_Chosen):
    """The utterance for the clipboard."""

    id = "flow.copy"
    key = "y,н"
    title = N_("Copy")
    tooltip = N_("Copy the steps of this utterance, with their delays, as text.")
    footer = True

    @classmethod
    async def run(cls, target: FlowTarget) -> None:
        """Copy."""
        target.copy_chain()


FLOW_ACTIONS = (
    OlderChain,
    NewerChain,
    PauseFlow,
    HideLane,
    ShowAllLanes,
    OtherLogs,
    ChangeTimeScale,
    CopyChain,
)
