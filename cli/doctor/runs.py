"""Deck's own state: its directories, running sessions, and remains of earlier runs."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import TYPE_CHECKING

from cli.doctor.finding import fail, ok, warn
from launcher.errors import LauncherError
from launcher.rundir import check_writable, found_run_dir, log_path
from text.i18n import LocalizedFloat, _, localized
from text.plain import plain
from text.run_path import run_path

if TYPE_CHECKING:
    from cli.doctor.finding import Finding
    from launcher.runs.record import FoundSupervisor

LEAST_FREE = 200 * 10**6
"""Bytes to keep free for logs; these are rotated but may still grow to a limit."""


@dataclass(frozen=True)
class RunFacts:
    """The state of Deck's directories and processes."""

    run_dir: str = ""
    log_dir: str = ""
    free: int = 10**10
    """Free bytes on the file system of the logs."""
    error: str = ""
    """Why a directory cannot be used."""
    running: tuple[str, ...] = ()
    apart: tuple[str, ...] = ()
    """Sessions that no other command sees: with another DECK_RUN_DIR, or in a container."""
    strays: tuple[tuple[int, str], ...] = ()
    """Process number and node."""


def collect() -> RunFacts:
    from launcher.client.client import running
    from launcher.runs.record import supervisors_everywhere
    from launcher.runs.strays import find_strays

    try:
        here, logs = found_run_dir() or run_path(os.environ), log_path()
        there = next(folder for folder in (logs, *logs.absolute().parents) if folder.exists())
        check_writable(there)
    except LauncherError as error:
        return RunFacts(error=localized(error.args[0]))
    status = os.statvfs(there)
    sessions = running()
    known = {session.run_id for session in sessions}
    others = [one for one in supervisors_everywhere() if one.run_id not in known]
    return RunFacts(
        run_dir=str(here),
        log_dir=str(logs),
        free=status.f_bavail * status.f_frsize,
        running=tuple(f"{each.name} ({each.domain})" for each in sessions),
        apart=tuple(map(_apart, others)),
        strays=tuple((stray.pid, stray.node) for stray in find_strays(here)),
    )


def _apart(supervisor: FoundSupervisor) -> str:
    record = supervisor.record()
    name = record.session.name if record is not None else supervisor.run_id
    return _("{name} (domain {domain}, supervisor {pid})").format(
        name=plain(name), domain=supervisor.domain, pid=supervisor.pid
    )


def diagnose(facts: RunFacts) -> list[Finding]:
    """Report what is all right and what is not."""
    if facts.error:
        return [fail("folders", facts.error, _("set DECK_RUN_DIR and DECK_LOG_DIR"))]
    return [_folders(facts), _running(facts), *_elsewhere(facts), *_strays(facts)]


def _folders(facts: RunFacts) -> Finding:
    text = _("logs in {path}, {size:.1f} GB free").format(path=facts.log_dir, size=LocalizedFloat(facts.free / 1e9))
    if facts.free < LEAST_FREE:
        return warn("folders", text, _("remove old logs there, or set DECK_LOG_DIR"))
    return ok("folders", text)


def _running(facts: RunFacts) -> Finding:
    if not facts.running:
        return ok("running", _("no profile is running"))
    return ok("running", _("running: {names}").format(names=", ".join(facts.running)))


def _elsewhere(facts: RunFacts) -> list[Finding]:
    if not facts.apart:
        return []
    text = _("also running, in a container or with another DECK_RUN_DIR: {names}")
    return [ok("apart", text.format(names=", ".join(facts.apart)))]


def _strays(facts: RunFacts) -> list[Finding]:
    if not facts.strays:
        return []
    names = ", ".join(f"{node} ({pid})" for pid, node in facts.strays)
    text = _("left behind by an earlier run: {names}").format(names=names)
    pids = " ".join(str(pid) for pid, _node in facts.strays)
    fix = _("the screen offers to stop them; or: kill {pids}").format(pids=pids)
    return [warn("strays", text, fix)]
