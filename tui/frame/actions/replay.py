"""The actions of a replay, on every screen."""

from __future__ import annotations

from typing import TYPE_CHECKING

from text.i18n import N_
from tui.actions.action import Announce, actions_of

if TYPE_CHECKING:
    from collections.abc import Callable

    from graph.replay.replay import Replay
    from tui.frame.host import Host

action: Announce[Host] = Announce()

SKIP_S = 5.0


def _in_replay(host: Host) -> bool:
    return host.feed.replay is not None


def _do(host: Host, act: Callable[[Replay], object]) -> None:
    if host.feed.replay is not None:
        act(host.feed.replay)
        host.replay_changed()


def _play_or_pause(host: Host) -> str:
    """Named after what it would do now."""
    replay = host.feed.replay
    return N_("Play") if replay is not None and replay.state.paused else N_("Pause")


@action(
    "replay.toggle",
    "f7",
    N_("Pause"),
    N_("Pause the recording, or play it; at its end, start again."),
    footer=True,
    priority=True,
    when=_in_replay,
    label=_play_or_pause,
)
def play_pause(host: Host) -> None:
    _do(host, lambda replay: replay.toggle())


@action(
    "replay.step",
    "full_stop,ю",
    N_("Step"),
    N_("Pause and show the next message of the topics on the screen."),
    when=_in_replay,
)
def step(host: Host) -> None:
    _do(host, lambda replay: replay.step())


@action("replay.back", "shift+left", N_("5 s back"), N_("Jump five seconds back in the recording."), when=_in_replay)
def back(host: Host) -> None:
    _do(host, lambda replay: replay.skip(-SKIP_S))


@action(
    "replay.forward",
    "shift+right",
    N_("5 s forward"),
    N_("Jump five seconds ahead in the recording."),
    when=_in_replay,
)
def forward(host: Host) -> None:
    _do(host, lambda replay: replay.skip(SKIP_S))


@action(
    "replay.slower",
    "minus,underscore",
    N_("Slower"),
    N_("Play the recording slower: down to a tenth."),
    when=_in_replay,
)
def slower_replay(host: Host) -> None:
    _do(host, lambda replay: replay.change_rate(faster=False))


@action(
    "replay.faster",
    "plus,equals_sign",
    N_("Faster"),
    N_("Play the recording faster: up to ten times."),
    when=_in_replay,
)
def faster_replay(host: Host) -> None:
    _do(host, lambda replay: replay.change_rate(faster=True))


@action(
    "replay.loop",
    "shift+f7",
    N_("Loop"),
    N_("At the end of the recording start again, or stay there."),
    when=_in_replay,
)
def loop(host: Host) -> None:
    _do(host, lambda replay: replay.set_loop(not replay.state.loop))


REPLAY_ACTIONS = actions_of(__name__)
