"""A node that Deck has started in words: its state, the reason, and its resource usage."""

from __future__ import annotations

from textual.content import Content

from launcher.status import HALTED, STUCK, THREAD, NodeState, NodeStatus
from text.figures import figure, whole
from text.i18n import N_, _, localized
from text.plain import plain

STATES = {
    NodeState.WAITING: ("◌", N_("waiting"), "dim"),
    NodeState.STARTING: ("◔", N_("starting"), "warn"),
    NodeState.READY: ("●", N_("ready"), "good"),
    NodeState.RUNNING: ("●", N_("running"), "good"),
    NodeState.STOPPING: ("◑", N_("stopping"), "warn"),
    NodeState.EXITED: ("○", N_("exited"), "dim"),
    NodeState.BACKOFF: ("↻", N_("restarts"), "warn"),
    NodeState.FAILED: ("✗", N_("failed"), "bad"),
}
"""Maps a state to sign, word and meaning: colour is never the only indication."""

AT_WORK = (NodeState.READY, NodeState.RUNNING)
"""In these, the state of a lifecycle may be shown in place of the word."""

LATE = ("◔", N_("running"), "warn")
"""For a node that runs, but was not ready in time."""
AILING = {STUCK: ("✗", N_("stuck"), "bad"), HALTED: ("✗", N_("halted"), "bad"), THREAD: ("✗", N_("running"), "bad")}
"""For a node whose process is there, and which is not at work."""
MINUTE_S, HOUR_S, DAY_S = 60, 3600, 86_400
LONGEST_S = 1000.0 * DAY_S
"""A node cannot have run for longer than this, or for a negative time."""


def state_words(node: NodeStatus) -> tuple[str, str, str]:
    if (ailing := ailing_words(node)) is not None:
        return ailing
    return LATE if node.late else STATES[node.state]


def ailing_words(node: NodeStatus) -> tuple[str, str, str] | None:
    """Return the same of a node that is not at work although its process is there, else None."""
    kind = node.fault.kind if node.fault is not None else ""
    return AILING.get(kind) if node.state in AT_WORK else None


def why(node: NodeStatus) -> str:
    if node.fault is not None:
        return plain(localized(node.fault.words))
    if node.detail:
        return plain(localized(node.detail))
    if node.signal:
        return _("ended by {signal}").format(signal=node.signal)
    if node.exit_code is not None and not node.state.alive:
        return _("exit code {code}").format(code=node.exit_code)
    return plain(node.command)


def duration(seconds: float | None) -> str:
    """Return a time in its two largest units, at most five cells: `7s`, `1m23`, `2h05`, `3d04`."""
    if seconds is None:
        return ""
    if not 0 <= seconds < LONGEST_S:
        return _("{n}s").format(n=figure(seconds, 0))
    whole = int(seconds)
    if whole < MINUTE_S:
        return _("{n}s").format(n=whole)
    if whole < HOUR_S:
        return _("{m}m{s:02d}").format(m=whole // MINUTE_S, s=whole % MINUTE_S)
    if whole < DAY_S:
        return _("{h}h{m:02d}").format(h=whole // HOUR_S, m=whole % HOUR_S // MINUTE_S)
    return _("{d}d{h:02d}").format(d=whole // DAY_S, h=whole % DAY_S // HOUR_S)


def percent(value: float | None) -> str:
    return "" if value is None else f"{whole(value)} %"


def memory(size: int | None) -> str:
    return "" if size is None else _("{n} MB").format(n=round(size / 1_000_000))


LONGEST = 400


def fault_lines(node: NodeStatus) -> list[Content]:
    """Return what is wrong with the node: the line of its file, the exception, what it means."""
    fault = node.fault
    if fault is None:
        return []
    place = f"{plain(fault.file.rpartition('/')[2], 80)}:{fault.line}: " if fault.file else ""
    still = _("the process from before still runs")
    still = f" ({still})" if fault.kind == "syntax" and node.state.alive else ""
    goes_on = fault.kind == "warning" and node.state.alive
    sign, colour = ("!", "$text-warning") if goes_on else ("✗", "$text-error")
    lines = [
        Content.assemble(
            (f"{sign} {place}", f"bold {colour}"),
            (plain(localized(fault.exception), LONGEST), colour),
            (still, "$text-muted"),
        )
    ]
    if fault.source_line:
        lines.append(Content.styled(f"    {plain(fault.source_line.strip(), LONGEST)}", "bold"))
    if fault.meaning:
        meaning = plain(localized(fault.meaning), LONGEST)
        lines.append(Content.styled(f"  → {meaning}", "$text-accent"))
    return lines
