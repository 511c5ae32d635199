"""Which domain a session gets, who is in it, and where its files lie."""

from __future__ import annotations

import os
import stat
import threading
from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest

from launcher.domain.discovery import OF_PEERS, ONLY_THESE, RANGE, TRANSPORTS, VARIABLES, settings_of_discovery
from launcher.domain.domain import default_domain, settings_of_domain
from launcher.errors import RunDirError
from launcher.run_id import new_run_id
from launcher.rundir import found_run_dir, run_dir
from launcher.runs import record as supervisor_record
from launcher.runs import shared_domain
from launcher.runs.record import RunRecord, exclusively
from launcher.runs.shared_domain import Neighbour, apart_from_classmates
from launcher.status import SessionInfo, Who
from tests.unit.profile_files import loaded
from text.run_path import run_path


def test_users_of_one_machine_get_different_safe_domains(monkeypatch: pytest.MonkeyPatch) -> None:
    domains = set()
    for uid in range(1000, 1040):
        monkeypatch.setattr(os, "getuid", lambda uid=uid: uid)
        domains.add(default_domain())
    assert len(domains) == 40
    assert min(domains) >= 1
    assert max(domains) <= 101


def test_localhost_keeps_the_network_out() -> None:
    assert settings_of_domain(42, "localhost") == {
        "ROS_DOMAIN_ID": "42",
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
        "ROS_STATIC_PEERS": None,
        "ROS_LOCALHOST_ONLY": None,
    }


def mode(path: Path) -> int:
    return stat.S_IMODE(path.stat().st_mode)


def test_the_run_directory_is_made_closed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("DECK_RUN_DIR", str(tmp_path / "a" / "b"))
    assert run_dir() == tmp_path / "a" / "b"
    assert mode(run_dir()) == 0o700


@pytest.mark.parametrize("permissions", [0o775, 0o1777])
@pytest.mark.parametrize("look", [run_dir, found_run_dir])
def test_a_folder_that_others_can_write_to_is_refused_and_left_as_it_is(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, permissions: int, look: Callable[[], object]
) -> None:
    (tmp_path / "r").mkdir()
    (tmp_path / "r").chmod(permissions)
    monkeypatch.setenv("DECK_RUN_DIR", str(tmp_path / "r"))
    with pytest.raises(RunDirError, match=r"others can write to .*chmod go-w"):
        look()
    assert mode(tmp_path / "r") == permissions


def test_a_run_directory_planted_as_a_link_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "r").symlink_to(tmp_path / "elsewhere")
    monkeypatch.setenv("DECK_RUN_DIR", str(tmp_path / "r"))
    with pytest.raises(RunDirError, match="is not a directory; remove it, or set DECK_RUN_DIR"):
        run_dir()


def test_somebody_elses_run_directory_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "r").mkdir()
    monkeypatch.setenv("DECK_RUN_DIR", str(tmp_path / "r"))
    monkeypatch.setattr(os, "getuid", lambda: 4_000_000)
    with pytest.raises(RunDirError, match="belongs to somebody else"):
        run_dir()


DOMAIN = 42


def test_where_somebody_else_has_planted_the_lock_starts_still_wait_for_each_other(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    planted = tmp_path / "planted"
    planted.mkdir()
    runs = tmp_path / "runs"
    runs.mkdir()
    monkeypatch.setattr(supervisor_record, "lock_path", lambda: planted)
    order: list[str] = []

    def second() -> None:
        with exclusively(runs, DOMAIN):
            order.append("second")

    with exclusively(runs, DOMAIN):
        waiting = threading.Thread(target=second)
        waiting.start()
        waiting.join(timeout=0.2)
        order.append("first")
    waiting.join()
    assert order == ["first", "second"]
    assert list(runs.iterdir()) == []


def test_on_one_machine_both_names_lead_to_the_file() -> None:
    chosen = settings_of_discovery({}, "localhost")
    assert set(chosen) == {*VARIABLES, ONLY_THESE, RANGE}
    # For LOCALHOST the middleware would add shared memory, and a port open to the network.
    assert chosen[RANGE] == "SYSTEM_DEFAULT"
    (path,) = {chosen[name] for name in VARIABLES}
    assert path is not None
    period = ET.parse(Path(path)).getroot().findtext(".//{*}leaseAnnouncement/{*}nanosec")
    assert period == "200000000"


@pytest.mark.parametrize(
    ("environ", "discovery", "settings"),
    [
        ({}, ("192.0.2.7",), {**dict.fromkeys(VARIABLES, str(OF_PEERS)), ONLY_THESE: "1", RANGE: "SUBNET"}),
        ({}, "subnet", {**dict.fromkeys((*VARIABLES, ONLY_THESE)), TRANSPORTS: "UDPv4"}),
        ({TRANSPORTS: "LARGE_DATA"}, "subnet", {**dict.fromkeys((*VARIABLES, ONLY_THESE)), TRANSPORTS: "LARGE_DATA"}),
        ({VARIABLES[0]: "/own.xml"}, "localhost", {}),
        # Whoever else is the middleware, the range alone keeps it from looking for others.
        ({"RMW_IMPLEMENTATION": "rmw_cyclonedds_cpp"}, "localhost", {}),
    ],
)
def test_what_others_are_to_find_and_what_the_user_has_chosen(
    environ: dict[str, str], discovery: str | tuple[str, ...], settings: dict[str, str | None]
) -> None:
    assert settings_of_discovery(environ, discovery) == settings


FROM_A = {"SSH_CONNECTION": "10.0.0.1 50000 10.0.0.9 22"}
FROM_B = {"SSH_CONNECTION": "10.0.0.2 50000 10.0.0.9 22"}
HELLO = "nodes: {hello: {run: nodes.hello}}"


@pytest.fixture
def beside(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Somebody who has logged in from 10.0.0.1 runs a lesson in whatever domain is asked for."""
    session = SessionInfo(new_run_id(), "", "02-sonar-safety", started_by=Who(host="10.0.0.1"))
    neighbour = Neighbour(RunRecord(tmp_path, session, ()), "", "")
    monkeypatch.setattr(shared_domain, "neighbours", lambda _everyone, _domain: [neighbour])
    monkeypatch.setattr(shared_domain, "supervisors", list)


@pytest.mark.usefixtures("beside")
def test_who_comes_from_another_machine_gets_a_domain_of_their_own(tmp_path: Path) -> None:
    profile = loaded(tmp_path, HELLO)
    assert apart_from_classmates(profile, FROM_B).domain == profile.domain % 101 + 1
    # The same person, or somebody at the machine itself, is asked instead.
    assert apart_from_classmates(profile, FROM_A).domain == profile.domain
    assert apart_from_classmates(profile, {}).domain == profile.domain


def test_the_run_directory_is_the_one_told_or_that_of_ones_own_login(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    login = {"XDG_RUNTIME_DIR": str(tmp_path)}
    assert run_path({"DECK_RUN_DIR": "/r", **login}) == Path("/r")
    assert run_path(login) == tmp_path / "deck"
    assert run_path({"XDG_RUNTIME_DIR": "/gone"}) == Path(f"/tmp/deck-{os.getuid()}")
    monkeypatch.setattr(os, "getuid", lambda: 4_000_000)
    assert run_path(login) == Path("/tmp/deck-4000000")
