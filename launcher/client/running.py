"""Finding the running session that a name refers to."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

from launcher.errors import NotRunningError, SeveralRunningError
from launcher.profile.catalog import fitting, is_path
from launcher.rundir import found_run_dir
from launcher.runs.found import supervisors
from launcher.runs.record import read_records
from text.run_path import OWN_RUN_DIR

if TYPE_CHECKING:
    from collections.abc import Sequence

    from launcher.runs.record import RunRecord


def running_records() -> list[RunRecord]:
    """Return all running sessions, oldest first, including those whose run directory was lost.

    Sessions with another `DECK_RUN_DIR` are left out.
    """
    here = found_run_dir()
    records = read_records(here) if here is not None else []
    found = {record.session.run_id: record for record in records if record.runs}
    for supervisor in supervisors():
        if supervisor.run_id in found or supervisor.purpose != os.environ.get(OWN_RUN_DIR, ""):
            continue
        record = supervisor.record()
        if record is not None:
            found[supervisor.run_id] = record
    return [found[run_id] for run_id in sorted(found)]


def find_running(name: str | None = None) -> RunRecord:
    """Return the running session: the only one, or the one with that run id or profile.

    A profile is given as it is for starting: by path, name, lesson number or start of a name.

    Raises:
        NotRunningError: if there is none.
        SeveralRunningError: if there are several to choose from.
    """
    found = running_records()
    chosen = found if name is None else _meant(name, found)
    names = [record.session.name for record in found]
    if not chosen:
        raise NotRunningError(name, names)
    if len(chosen) > 1:
        raise SeveralRunningError(names if len(set(names)) == len(names) else [one.session.run_id for one in chosen])
    return chosen[0]


def _meant(name: str, found: Sequence[RunRecord]) -> list[RunRecord]:
    exactly = [one for one in found if name in (one.session.name, one.session.run_id)]
    if exactly:
        return exactly
    if is_path(name):
        path = os.path.realpath(name)
        return [one for one in found if os.path.realpath(one.session.profile) == path]
    # Not looked up in the catalogue: the file may be gone, or not visible from here.
    fits = fitting(name, {one.session.name for one in found})
    return [one for one in found if one.session.name in fits]
