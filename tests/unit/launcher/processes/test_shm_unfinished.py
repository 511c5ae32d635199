"""Files whose maker was killed while it made them hold up nobody."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

import pytest

from launcher.processes.shared_memory_unfinished import (
    UNFINISHED_S,
    Discarded,
    discard_unfinished,
    unfinished,
)
from launcher.status import Severity
from launcher.supervisor.shared_memory import SharedMemory
from tests.unit.launcher.processes.test_shm import DEAD, made

if TYPE_CHECKING:
    from pathlib import Path


@pytest.mark.parametrize("begun", [b"", bytes(4096), b"\1" + bytes(4095)])
def test_what_nobody_will_finish_is_removed_and_who_waits_is_let_go(
    tmp_path: Path, begun: bytes
) -> None:
    path = made(tmp_path / "fastrtps_port7001", begun)
    with path.open("rb") as waiting:
        assert discard_unfinished(tmp_path) == Discarded(("fastrtps_port7001",), ())
        assert waiting.read(4) == b"\3\0\0\0"
    assert not path.exists()


def test_what_is_finished_or_just_being_made_stays(tmp_path: Path) -> None:
    made(tmp_path / DEAD, b"\2" + bytes(4095))
    made(tmp_path / f"{DEAD}_el", b"")
    made(tmp_path / "fastrtps_port7001", b"\1" + bytes(4095), age_s=UNFINISHED_S / 2)
    made(tmp_path / "somebody_elses", b"")
    (tmp_path / "fastrtps_port7002").symlink_to(made(tmp_path / "precious", b""))
    (tmp_path / "fastrtps_port7003").mkdir()
    before = sorted(tmp_path.iterdir())
    assert discard_unfinished(tmp_path) == Discarded((), ())
    assert sorted(tmp_path.iterdir()) == before


@pytest.fixture
def of_another_user(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A file that may be read, and no more."""
    really = os.open

    def refuse(file: str, flags: int) -> int:
        if flags & os.O_RDWR:
            raise PermissionError
        return really(file, flags)

    monkeypatch.setattr(os, "open", refuse)
    return made(tmp_path / "fastrtps_port7002", b"")


def test_what_belongs_to_another_user_stays(tmp_path: Path, of_another_user: Path) -> None:
    assert list(unfinished(tmp_path)) == [of_another_user]
    assert discard_unfinished(tmp_path) == Discarded((), ("fastrtps_port7002",))
    assert of_another_user.exists()


def test_the_superuser_removes_nothing_of_other_users(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Nothing but the owner keeps him from it."""
    path = made(tmp_path / "fastrtps_port7002", b"")
    monkeypatch.setattr(os, "geteuid", lambda: path.stat().st_uid + 1)
    assert discard_unfinished(tmp_path) == Discarded((), ("fastrtps_port7002",))
    assert path.read_bytes() == b""


def test_what_has_another_name_as_well_is_somebodys_and_stays(tmp_path: Path) -> None:
    precious = made(tmp_path / "precious", b"")
    (tmp_path / "fastrtps_port7002").hardlink_to(precious)
    assert discard_unfinished(tmp_path) == Discarded((), ("fastrtps_port7002",))
    assert precious.read_bytes() == b""


def test_where_there_is_no_shared_memory_nothing_is_unfinished(tmp_path: Path) -> None:
    assert discard_unfinished(tmp_path / "none") == Discarded((), ())


def test_what_is_removed_is_told_of(tmp_path: Path) -> None:
    told: list[tuple[Severity, str]] = []
    memory = SharedMemory(lambda *line: told.append(line), tmp_path)
    memory.clear()
    assert told == []
    made(tmp_path / "fastrtps_port7001", b"")
    memory.clear()
    memory.clear()
    assert [severity for severity, _words in told] == [Severity.WARN]
    assert told[0][1].startswith("removed fastrtps_port7001 from /dev/shm")


@pytest.mark.usefixtures("of_another_user")
def test_what_cannot_be_removed_is_told_of_once(tmp_path: Path) -> None:
    told: list[tuple[Severity, str]] = []
    memory = SharedMemory(lambda *line: told.append(line), tmp_path)
    memory.clear()
    memory.clear()
    assert [severity for severity, _words in told] == [Severity.ERROR]
    assert told[0][1].endswith("sudo rm /dev/shm/fastrtps_port7002")
