"""The actions of a replay, on every screen."""

from __future__ import annotations

from typing import TYPE_CHECKING

from text.i18n import N_
from tui.actions.action import Action

if TYPE_CHECKING:
    from graph.replay.replay import Replay
    from tui.frame.host import Host

SKIP_S = 5.0


class ReplayAction(Action["Host"]):
    """An action that needs a replay."""

    @classmethod
    def possible(cls, target: Host) -> bool | None:
        """Only in a replay."""
        return target.feed.replay is not None

    @classmethod
    async def run(cls, target: Host) -> None:
        if target.feed.replay is not None:
            cls.do(target.feed.replay)
            target.replay_changed()

    @classmethod
    def do(cls, replay: Replay) -> None:
        raise NotImplementedError


class PlayPause(ReplayAction):
    """Pause, or play."""

    id = "replay.toggle"
    key = "f7"
    title = N_("Pause")
    tooltip = N_("Pause the recording, or play it; at its end, start again.")
    footer = True
    priority = True

    @classmethod
    def label(cls, target: Host) -> str:
        """Named after what it would do now."""
        replay = target.feed.replay
        return N_("Play") if replay is not None and replay.state.paused else cls.title

    @classmethod
    def do(cls, replay: Replay) -> None:
        replay.toggle()


class Step(ReplayAction):
    """Play one message."""

    id = "replay.step"
    key = "full_stop,ю"
    title = N_("Step")
    tooltip = N_("Pause and show the next message of the topics on the screen.")

    @classmethod
    def do(cls, replay: Replay) -> None:
        replay.step()


class Back(ReplayAction):
    """Jump back a little."""

    id = "replay.back"
    key = "shift+left"
    title = N_("5 s back")
    tooltip = N_("Jump five seconds back in the recording.")

    @classmethod
    def do(cls, replay: Replay) -> None:
        replay.skip(-SKIP_S)


class Forward(ReplayAction):
    """Jump ahead a little."""

    id = "replay.forward"
    key = "shift+right"
    title = N_("5 s forward")
    tooltip = N_("Jump five seconds ahead in the recording.")

    @classmethod
    def do(cls, replay: Replay) -> None:
        replay.skip(SKIP_S)


class SlowerReplay(ReplayAction):
    """Play more slowly."""

    id = "replay.slower"
    key = "minus,underscore"
    title = N_("Slower")
    tooltip = N_("Play the recording slower: down to a tenth.")

    @classmethod
    def do(cls, replay: Replay) -> None:
        """Use the next lower rate."""
        replay.change_rate(faster=False)


class FasterReplay(ReplayAction):
    """Play faster."""

    id = "replay.faster"
    key = "plus,equals_sign"
    title = N_("Faster")
    tooltip = N_("Play the recording faster: up to ten times.")

    @classmethod
    def do(cls, replay: Replay) -> None:
        """Use the next higher rate."""
        replay.change_rate(faster=True)


class Loop(ReplayAction):
    """Repeat the recording."""

    id = "replay.loop"
    key = "shift+f7"
    title = N_("Loop")
    tooltip = N_("At the end of the recording start again, or stay there.")

    @classmethod
    def do(cls, replay: Replay) -> None:
        replay.set_loop(not replay.state.loop)


REPLAY_ACTIONS = (PlayPause, Step, Back, Forward, SlowerReplay, FasterReplay, Loop)
