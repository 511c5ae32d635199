"""Which other sessions of this user are in a ROS domain, whatever their run directory."""

from __future__ import annotations

import shlex
from dataclasses import dataclass
from typing import TYPE_CHECKING

from launcher.domain import LAST_SAFE_DOMAIN
from launcher.rundir import OWN_RUN_DIR
from launcher.supervisor_found import supervisors

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from launcher.supervisor_record import RunRecord


@dataclass(frozen=True)
class Neighbour:
    """Another session."""

    record: RunRecord
    run_dir: str
    """Where its folder is."""
    purpose: str
    """Its `DECK_RUN_DIR`."""

    @property
    def down(self) -> str:
        """What is typed to stop it, in a shell with another `DECK_RUN_DIR`."""
        if not self.purpose:
            return f"env -u {OWN_RUN_DIR} deck down"
        return f"{OWN_RUN_DIR}={shlex.quote(self.purpose)} deck down"


def neighbours() -> list[Neighbour]:
    """Return every session of this user that runs, oldest first."""
    found = []
    for supervisor in supervisors():
        place, record = supervisor.place, supervisor.record()
        if record is not None:
            found.append(Neighbour(record, place.rpartition("/")[0], supervisor.purpose))
    return sorted(found, key=lambda one: one.record.session.run_id)


def rival(others: Iterable[Neighbour], record: RunRecord) -> Neighbour | None:
    """Return one that cannot be in the same domain as this run: a robot is driven once."""
    for other in others:
        if other.record.session.domain == record.session.domain and other.record.collides(record):
            return other
    return None


def free_domain(others: Sequence[Neighbour], domain: int) -> int:
    """Return the next domain after this one in which none of these sessions runs."""
    taken = {domain, *(other.record.session.domain for other in others)}
    for step in range(1, LAST_SAFE_DOMAIN + 1):
        candidate = (domain - 1 + step) % LAST_SAFE_DOMAIN + 1
        if candidate not in taken:
            return candidate
    return domain
