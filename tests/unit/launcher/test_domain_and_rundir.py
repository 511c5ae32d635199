"""Where a run lives: a ROS domain of one's own, and a directory closed to all others."""

from __future__ import annotations

import os
import stat
from collections.abc import Callable
from pathlib import Path

import pytest

from launcher.domain.domain import default_domain, ros_environment
from launcher.errors import RunDirError
from launcher.rundir import found_run_dir, log_dir, run_dir


def test_users_of_one_machine_get_different_safe_domains(monkeypatch: pytest.MonkeyPatch) -> None:
    domains = set()
    for uid in range(1000, 1040):
        monkeypatch.setattr(os, "getuid", lambda uid=uid: uid)
        domains.add(default_domain())
    assert len(domains) == 40
    assert min(domains) >= 1
    assert max(domains) <= 101


def test_localhost_keeps_the_network_out() -> None:
    old = {"ROS_LOCALHOST_ONLY": "1", "ROS_STATIC_PEERS": "evil", "HOME": "/h"}
    assert ros_environment(old, 42, "localhost") == {
        "HOME": "/h",
        "ROS_DOMAIN_ID": "42",
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
    }


def test_subnet_and_static_peers() -> None:
    assert ros_environment({}, 1, "subnet")["ROS_AUTOMATIC_DISCOVERY_RANGE"] == "SUBNET"
    peers = ros_environment({}, 1, ("10.0.0.2", "robot.local"))
    assert peers["ROS_STATIC_PEERS"] == "10.0.0.2;robot.local"
    assert peers["ROS_AUTOMATIC_DISCOVERY_RANGE"] == "LOCALHOST"


def mode(path: Path) -> int:
    """Return the permissions of a path."""
    return stat.S_IMODE(path.stat().st_mode)


def test_the_run_directory_is_made_closed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("DECK_RUN_DIR", str(tmp_path / "a" / "b"))
    assert run_dir() == tmp_path / "a" / "b"
    assert mode(run_dir()) == 0o700


def test_a_folder_that_others_can_read_is_used_as_it_is(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "r").mkdir()
    (tmp_path / "r").chmod(0o755)
    monkeypatch.setenv("DECK_RUN_DIR", str(tmp_path / "r"))
    assert mode(run_dir()) == 0o755
    assert found_run_dir() == run_dir()


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


def test_whoever_looks_makes_no_run_directory(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("DECK_RUN_DIR", str(tmp_path / "a" / "b"))
    assert found_run_dir() is None
    assert list(tmp_path.iterdir()) == []


def test_a_run_directory_planted_as_a_link_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "r").symlink_to(tmp_path / "elsewhere")
    monkeypatch.setenv("DECK_RUN_DIR", str(tmp_path / "r"))
    with pytest.raises(RunDirError, match="is not a directory; remove it, or set DECK_RUN_DIR"):
        run_dir()


def test_somebody_elses_run_directory_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "r").mkdir()
    monkeypatch.setenv("DECK_RUN_DIR", str(tmp_path / "r"))
    monkeypatch.setattr(os, "getuid", lambda: 4_000_000)
    with pytest.raises(RunDirError, match="belongs to somebody else"):
        run_dir()


def test_the_session_of_the_login_is_used_where_there_is_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("DECK_RUN_DIR")
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    assert run_dir() == tmp_path / "deck"


def test_logs_outlive_the_login(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("DECK_LOG_DIR")
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    assert log_dir() == tmp_path / "state" / "deck" / "logs"
    assert log_dir().is_dir()


def test_logs_that_cannot_be_written_are_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("DECK_LOG_DIR", str(tmp_path / "file" / "logs"))
    with pytest.raises(RunDirError, match="cannot be created: Not a directory"):
        log_dir()
