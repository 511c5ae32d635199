"""Classmates who share one account, each with a lesson of their own."""

from __future__ import annotations

from pathlib import Path

import pytest

from launcher.run_id import new_run_id
from launcher.runs import shared_domain
from launcher.runs.record import RunRecord
from launcher.runs.shared_domain import Neighbour, apart_from_classmates
from launcher.status import SessionInfo, Who
from tests.unit.profile_files import loaded

FROM_A = {"SSH_CONNECTION": "10.0.0.1 50000 10.0.0.9 22"}
FROM_B = {"SSH_CONNECTION": "10.0.0.2 50000 10.0.0.9 22"}
HELLO = "nodes: {hello: {run: nodes.hello}}"


@pytest.fixture
def beside(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Somebody who has logged in from 10.0.0.1 runs a lesson in whatever domain is asked for."""
    session = SessionInfo(new_run_id(), "", "02-sonar-safety", started_by=Who(host="10.0.0.1"))
    neighbour = Neighbour(RunRecord(tmp_path, session, (), {}), "", "")
    monkeypatch.setattr(shared_domain, "neighbours", lambda _everyone, _domain: [neighbour])
    monkeypatch.setattr(shared_domain, "supervisors", list)


@pytest.mark.usefixtures("beside")
def test_who_comes_from_another_machine_gets_a_domain_of_their_own(tmp_path: Path) -> None:
    profile = loaded(tmp_path, HELLO)
    assert apart_from_classmates(profile, None, FROM_B).domain == profile.domain % 101 + 1
    # The same person, or somebody at the machine itself, is asked instead.
    assert apart_from_classmates(profile, None, FROM_A).domain == profile.domain
    assert apart_from_classmates(profile, None, {}).domain == profile.domain


@pytest.mark.usefixtures("beside")
def test_a_domain_that_was_chosen_stays(tmp_path: Path) -> None:
    profile = loaded(tmp_path, f"domain: 9\n{HELLO}")
    assert apart_from_classmates(profile, None, FROM_B).domain == 9
    asked = loaded(tmp_path, HELLO, domain=7)
    assert apart_from_classmates(asked, 7, FROM_B).domain == 7
    assert apart_from_classmates(asked, None, {**FROM_B, "ROS_DOMAIN_ID": "7"}).domain == 7
