"""The actions of the Flow screen; each letter also works as the Cyrillic one on its key."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from text.i18n import N_
from tui.actions.action import Action

if TYPE_CHECKING:
    from tui.flow.chains import Chain, FlowStep, Lane


class FlowTarget(Protocol):
    """The part of the Flow screen that its actions use."""

    @property
    def chosen_step(self) -> FlowStep | None:
        """The step at the cursor."""

    paused: bool
    """Whether new steps are held back."""

    def neighbour(self, step: int) -> Chain | None:
        """Return the chain this many places below the chosen one."""

    def go(self, step: int) -> None:
        """Go to that chain."""

    def toggle_pause(self) -> None:
        """Pause, or resume."""

    def toggle_lane(self, lane: Lane) -> None:
        """Hide the steps of this lane, or show them."""

    def show_all(self) -> None:
        """Hide nothing."""

    def toggle_logs(self) -> None:
        """Show the logs of other nodes, or hide them."""

    def toggle_scale(self) -> None:
        """Switch between a logarithmic and a linear time axis."""

    def copy_chain(self) -> None:
        """Copy the chosen chain."""


class FlowAction(Action[FlowTarget]):
    """An action on the timeline."""

    from_elsewhere = True


class _Chosen(FlowAction):
    """An action on the chosen step."""

    from_elsewhere = False

    @classmethod
    def possible(cls, target: FlowTarget) -> bool | None:
        """Only if a step is chosen."""
        return True if target.chosen_step else None


class OlderChain(FlowAction):
    """Go to the previous utterance."""

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
        target.go(1)


class NewerChain(FlowAction):
    """Go to the next utterance."""

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
        target.go(-1)


class PauseFlow(FlowAction):
    """Pause the timeline."""

    id = "flow.pause"
    key = "p,з"
    title = N_("Pause")
    tooltip = N_("Freeze the timeline, or show what has happened since.")
    footer = True

    @classmethod
    def label(cls, target: FlowTarget) -> str:
        """Named after what it would do now."""
        return N_("Resume") if target.paused else cls.title

    @classmethod
    async def run(cls, target: FlowTarget) -> None:
        target.toggle_pause()


class HideLane(_Chosen):
    """Hide the lane of the chosen step."""

    id = "flow.hide"
    key = "m,ь"
    title = N_("Hide")
    means = "leave out"
    tooltip = N_("Hide all steps of the same kind as the selected one: microphone, brain, wheels...")
    footer = True

    @classmethod
    async def run(cls, target: FlowTarget) -> None:
        if target.chosen_step:
            target.toggle_lane(target.chosen_step.lane)


class ShowAllLanes(FlowAction):
    """Show every lane."""

    id = "flow.all"
    key = "a,ф"
    title = N_("Show all")
    means = "all"
    tooltip = N_("Show every step again, without the logs of other nodes.")
    footer = True

    @classmethod
    async def run(cls, target: FlowTarget) -> None:
        target.show_all()


class OtherLogs(FlowAction):
    """Show the log lines of other nodes."""

    id = "flow.logs"
    key = "F,А"
    title = N_("Other logs")
    means = "how much of the log"
    tooltip = N_("Show or hide what other nodes wrote into their logs meanwhile.")
    footer = True

    @classmethod
    async def run(cls, target: FlowTarget) -> None:
        target.toggle_logs()


class ChangeTimeScale(FlowAction):
    """A linear time axis, or one that stretches the beginning."""

    id = "flow.scale"
    key = "A,Ф"
    title = N_("Scale")
    means = "time axis"
    tooltip = N_("Stretch the first milliseconds on the time axis, or make it linear.")
    footer = True

    @classmethod
    async def run(cls, target: FlowTarget) -> None:
        target.toggle_scale()


class CopyChain(_Chosen):
    """Copy the utterance to the clipboard."""

    id = "flow.copy"
    key = "y,н"
    title = N_("Copy")
    tooltip = N_("Copy the steps of this utterance, with their delays, as text.")
    footer = True

    @classmethod
    async def run(cls, target: FlowTarget) -> None:
        target.copy_chain()


FLOW_ACTIONS = (OlderChain, NewerChain, PauseFlow, HideLane, ShowAllLanes, OtherLogs, ChangeTimeScale, CopyChain)
