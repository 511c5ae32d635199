"""The output of `deck run`: lines for people, or JSON for programs.

JSON has one object per line, distinguished by `event`:

    session   the profile as started: name, domain, hardware, log_dir, ...
    status    a node's state has changed: node, state, detail, pid, restarts, exit_code, signal
    log       a line of a node: node, seq, time (unix), severity, text, logger, source
    skipped   node and lines: so many lines were left out here, the log file has them
    summary   the last one: healthy, exit_code, reason (what ended the run if nobody here did),
              seconds, and nodes as for `status` with `healthy`, and `asked`: false if nothing
              is known but that its process runs
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple, TypeAlias

from launcher.status import LogLine, NodeState, NodeStatus, SessionInfo, Severity
from text.i18n import LocalizedFloat, _, localized, ngettext
from text.output import BOLD, DIM, PREFIX_COLOURS, RED, YELLOW, Paint, json_text, table
from text.plain import plain
from tui.session.words import hardware_words

Write: TypeAlias = Callable[[str], None]
COLOURS = {Severity.WARN: YELLOW, Severity.ERROR: RED, Severity.FATAL: RED, Severity.DEBUG: DIM}
DECK = "deck"
_OF_SESSION = (
    *("name", "profile", "title", "lesson", "run_id", "domain", "discovery", "hardware", "supervisor_pid"),
    "log_dir",
)


class Summary(NamedTuple):
    """The result of a run."""

    nodes: Sequence[NodeStatus]
    """Their statuses before they were stopped."""
    healthy: Mapping[str, bool]
    """Node to whether it is healthy."""
    seconds: float
    reason: str
    """What ended the run, empty if it was stopped here."""

    @property
    def well(self) -> bool:
        """Whether every node was healthy and the run was stopped here."""
        return all(self.healthy.values()) and not self.reason

    @property
    def exit_code(self) -> int:
        return 0 if self.well else 1


class TextReport:
    """Lines for people, each prefixed with the name of its node."""

    def __init__(self, write: Write, names: Sequence[str], paint: Paint) -> None:
        """`names`: of the nodes; they determine the width of the prefix."""
        self._write = write
        self._paint = paint
        self._width = max(map(len, (*names, DECK))) + 2
        self._colours = {name: PREFIX_COLOURS[index % len(PREFIX_COLOURS)] for index, name in enumerate(names)}

    def session(self, session: SessionInfo) -> None:
        """Report what was started, and how to stop it."""
        words = _("{name}: domain {domain}, {hardware} hardware; Ctrl-C stops it")
        hardware = hardware_words(session.hardware)
        self.note(words.format(name=session.name, domain=session.domain, hardware=hardware))

    def status(self, node: NodeStatus) -> None:
        """Report states that the log does not show."""
        if node.state is NodeState.READY:
            self._line(node.name, self._paint(_("ready"), DIM))

    def log(self, line: LogLine) -> None:
        """Write a line of a node, with its severity as a word and a colour."""
        text = localized(line.text)
        if line.severity is not Severity.INFO:
            text = f"{line.severity.name} {text}"
        colour = COLOURS.get(line.severity) or (DIM if line.source == DECK else "")
        self._line(line.node, self._paint(text, colour) if colour else plain(text))

    def skipped(self, node: str, lines: int) -> None:
        words = ngettext(
            "{count} line left out, the log file has it", "{count} lines left out, the log file has them", lines
        )
        self._line(node, self._paint(words.format(count=lines), DIM))

    def note(self, text: str) -> None:
        """Report something about the run itself."""
        self._line(DECK, plain(text))

    def summary(self, summary: Summary) -> None:
        nodes, healthy = summary.nodes, summary.healthy
        head = (_("NODE"), _("RESULT"), _("STATE"), _("RESTARTS"), _("DETAIL"))
        rows = [
            (
                node.name,
                (_("runs") if node.unasked else _("healthy")) if healthy[node.name] else _("FAILED"),
                _(node.state.value),
                str(node.restarts),
                localized(node.why),
            )
            for node in nodes
        ]
        first, *others = table(head, rows)
        self._write("")
        self._write(self._paint(first, BOLD))
        for node, line in zip(nodes, others, strict=True):
            self._write(line if healthy[node.name] else self._paint(line, RED))
        bad = [node.name for node in nodes if not healthy[node.name]]
        parts = []
        if bad:
            parts.append(_("not healthy: {names}").format(names=", ".join(bad)))
        if summary.reason:
            parts.append(_("ended from elsewhere: {reason}").format(reason=localized(summary.reason)))
        unasked = [node.name for node in nodes if healthy[node.name] and node.unasked]
        if not parts and unasked:
            words = _("no node has failed; not asked whether at work: {names}")
            parts.append(words.format(names=", ".join(unasked)))
        words = plain("; ".join(parts)) or _("every node stayed healthy")
        self._write(_("{words}; {seconds:.1f} s").format(words=words, seconds=LocalizedFloat(summary.seconds)))

    def _line(self, node: str, text: str) -> None:
        prefix = f"[{node}]".ljust(self._width)
        colour = self._colours.get(node, BOLD)
        self._write(f"{self._paint(prefix, colour)} {text}")


class JsonReport:
    """One JSON object per line, as the module describes."""

    def __init__(self, write: Write) -> None:
        self._write = write

    def session(self, session: SessionInfo) -> None:
        self._object("session", **fields_of(session, *_OF_SESSION))

    def status(self, node: NodeStatus) -> None:
        self._object("status", **status_fields(node))

    def log(self, line: LogLine) -> None:
        rest = fields_of(line, "text", "logger", "source")
        self._object("log", node=line.node, seq=line.seq, time=line.time_s, severity=line.severity.value, **rest)

    def skipped(self, node: str, lines: int) -> None:
        self._object("skipped", node=node, lines=lines)

    def note(self, text: str) -> None:
        """Do nothing: everything that programs need has its own event."""

    def summary(self, summary: Summary) -> None:
        self._object(
            "summary",
            healthy=summary.well,
            exit_code=summary.exit_code,
            reason=summary.reason,
            seconds=round(summary.seconds, 3),
            nodes=[
                {**status_fields(node), "healthy": summary.healthy[node.name], "asked": not node.unasked}
                for node in summary.nodes
            ],
        )

    def _object(self, event: str, **fields: object) -> None:
        self._write(json_text({"event": event, **fields}))


def fields_of(told: object, *names: str) -> dict[str, object]:
    """Return some of its fields, as JSON has them."""
    return {name: getattr(told, name) for name in names}


def status_fields(node: NodeStatus) -> dict[str, object]:
    first = {"node": node.name, "state": node.state.value, "detail": node.why}
    return {**first, **fields_of(node, "pid", "restarts", "exit_code", "signal")}


Report: TypeAlias = TextReport | JsonReport
