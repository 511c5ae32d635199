"""A running profile and its nodes, as a table for people and as JSON for programs."""

from __future__ import annotations

import sys
from collections.abc import Collection, Iterable, Mapping, Sequence

from cli.domains import stop_is_kept
from cli.health import well
from cli.report import fields_of, status_fields
from launcher.status import NodeStatus, SessionInfo
from text.i18n import _, decimal, localized, pick
from text.output import BOLD, DIM, RED, Paint, table, write
from text.plain import plain
from tui.session.words import hardware_words


def show(session: SessionInfo, nodes: Sequence[NodeStatus], optional: Collection[str] = ()) -> None:
    """Write the session and a line for each node; the `optional` ones are never alarming."""
    paint = Paint(sys.stdout)
    where = _("domain {domain}, {hardware} hardware, supervisor {pid}").format(
        domain=session.domain, hardware=hardware_words(session.hardware), pid=session.supervisor_pid
    )
    write(f"{paint(session.name, BOLD)}  {pick(session.title)}  {paint(f'({where})', DIM)}")
    head = (_("NODE"), _("STATE"), "PID", _("UPTIME"), _("RESTARTS"), _("CPU %"), _("MB"), _("DETAIL"))
    rows = [_row(node) for node in nodes]
    first, *lines = table(head, rows)
    write(paint(first, DIM))
    for node, line in zip(nodes, lines, strict=True):
        write(line if well(node, optional) else paint(line, RED))


def _row(node: NodeStatus) -> tuple[str, ...]:
    return (
        node.name,
        _(node.state.value),
        "" if node.pid is None else str(node.pid),
        "" if node.uptime_s is None else _duration(node.uptime_s),
        str(node.restarts),
        "" if node.cpu_percent is None else decimal(f"{node.cpu_percent:.1f}"),
        "" if node.memory_bytes is None else f"{node.memory_bytes / 1e6:.0f}",
        localized(node.why),
    )


def _duration(seconds: float) -> str:
    """Return `12 s`, `3:07` or `1:02:03`."""
    whole = int(seconds)
    if whole < 60:
        return _("{seconds} s").format(seconds=whole)
    hours, rest = divmod(whole, 3600)
    minutes = f"{rest // 60:02d}:{rest % 60:02d}" if hours else f"{rest // 60}:{rest % 60:02d}"
    return f"{hours}:{minutes}" if hours else minutes


def silent_words(session: SessionInfo, pids: Mapping[str, int]) -> str:
    """Return who runs, and may drive, in a session whose supervisor does not answer."""
    nodes = ", ".join(f"{plain(name)} ({pid})" for name, pid in pids.items())
    return _(
        "deck: {name} (domain {domain}): the supervisor (pid {pid}) does not answer; its nodes run"
        " on: {nodes}; `deck stop` stops the robot, `deck down {name}` ends all of it"
    ).format(name=plain(session.name), domain=session.domain, pid=session.supervisor_pid, nodes=nodes or _("none"))


def silent_as_json(session: SessionInfo, pids: Mapping[str, int]) -> dict[str, object]:
    """Return the same in the form of `deck ps --json`: of the nodes only name and number."""
    nodes = [{"node": name, "pid": pid} for name, pid in pids.items()]
    return {**as_json(session, ()), "supervisor_answers": False, "nodes": nodes}


def as_json(session: SessionInfo, nodes: Iterable[NodeStatus]) -> dict[str, object]:
    first = fields_of(session, "name", "run_id", "profile", "domain", "hardware", "foreground", "supervisor_pid")
    figures = ("uptime_s", "cpu_percent", "memory_bytes")
    return {
        **first,
        "supervisor_answers": True,
        "log_dir": session.log_dir,
        "emergency_stop": stop_is_kept(session.domain),
        "nodes": [{**status_fields(node), "healthy": well(node), **fields_of(node, *figures)} for node in nodes],
    }
