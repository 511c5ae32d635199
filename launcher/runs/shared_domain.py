"""Finding other sessions of this user in a ROS domain, whatever their run directory."""

from __future__ import annotations

import os
import shlex
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from launcher.domain.domain import LAST_SAFE_DOMAIN
from launcher.errors import DomainTakenError
from launcher.processes.owner import who_words
from launcher.run_id import supervisor_of
from launcher.runs.record import FoundSupervisor, RunRecord, supervisors
from launcher.status import SessionInfo
from text.run_path import OWN_RUN_DIR
from text.sentences import Words, say

if TYPE_CHECKING:
    from launcher.profile.load import Profile


@dataclass(frozen=True)
class Neighbour:
    """Another session in the same ROS domain, of whatever run directory."""

    record: RunRecord
    run_dir: str
    """The place of its folder, for display."""
    purpose: str
    """Its `DECK_RUN_DIR`."""

    @property
    def words(self) -> Words:
        """Name it and the user who started it."""
        session = self.record.session
        return say(
            "{name}: {who}, supervisor {pid}",
            name=session.name,
            who=who_words(session.started_by),
            pid=session.supervisor_pid,
        )

    @property
    def down(self) -> str:
        """The command that stops it from a shell with another `DECK_RUN_DIR`."""
        if not self.purpose:
            return f"env -u {OWN_RUN_DIR} deck down"
        return f"{OWN_RUN_DIR}={shlex.quote(self.purpose)} deck down"


def neighbours(everyone: Iterable[FoundSupervisor], domain: int) -> list[Neighbour]:
    """Return the sessions in a domain, oldest first."""
    found = []
    for supervisor in everyone:
        if supervisor.domain != domain:
            continue
        place, record = supervisor.place, supervisor.record()
        if record is None and supervisor.holds:
            record = _unknown(supervisor)
        if record is not None:
            found.append(Neighbour(record, place.rpartition("/")[0], supervisor.purpose))
    return sorted(found, key=lambda one: one.record.session.run_id)


def _unknown(supervisor: FoundSupervisor) -> RunRecord:
    """Return a substitute for the record of a running supervisor that cannot write one."""
    session = SessionInfo(
        run_id=supervisor.run_id,
        profile="",
        name=supervisor.run_id,
        domain=supervisor.domain,
        supervisor_pid=supervisor_of(supervisor.run_id),
    )
    return RunRecord(supervisor.folder, session, ())


def refuse_shared_domain(profile: Profile) -> None:
    """Make sure that a profile would be alone in its domain.

    Raises:
        DomainTakenError: if another session of this user is in it.
    """
    everyone = list(supervisors())
    here = neighbours(everyone, profile.domain)
    if not here:
        return
    driving = any(node.drives for node in profile.nodes.values())
    raise DomainTakenError(
        profile.domain,
        [one.words for one in here],
        free_domain(everyone, profile.domain),
        can_share=not any(one.record.collides(set(profile.nodes), driving) for one in here),
    )


def apart_from_classmates(profile: Profile, environ: Mapping[str, str] = os.environ) -> Profile:
    """Return the profile, in a free domain if a classmate with the same account is in its own.

    A classmate is who has logged in by SSH from another address. A domain that somebody has chosen
    stays.
    """
    if profile.is_domain_chosen:
        return profile
    us = environ.get("SSH_CONNECTION", "").split(" ")[0]
    everyone = list(supervisors())
    hosts = {one.record.session.started_by.host for one in neighbours(everyone, profile.domain)}
    if not us or not hosts - {us, ""}:
        return profile
    return profile.model_copy(update={"domain": free_domain(everyone, profile.domain)})


def rival(everyone: Iterable[FoundSupervisor], record: RunRecord) -> Neighbour | None:
    """Return a session that must not share a domain with this run: a robot has one driver."""
    for other in neighbours(everyone, record.session.domain):
        if other.record.collides(set(record.nodes), record.drives):
            return other
    return None


def free_domain(everyone: Iterable[FoundSupervisor], domain: int) -> int:
    """Return the next domain after this one in which none of these sessions is running."""
    taken = {domain, *(one.domain for one in everyone)}
    for step in range(1, LAST_SAFE_DOMAIN + 1):
        candidate = (domain - 1 + step) % LAST_SAFE_DOMAIN + 1
        if candidate not in taken:
            return candidate
    return domain
