"""Files whose maker was killed while it made them hold up nobody."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

import pytest

from launcher.process_shm_unfinished import (
    UNFINISHED_S,
    Discarded,
    discard_unfinished,
    unfinished,
)
from tests.unit.test_process_shm import DEAD, made

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


def test_what_belongs_to_another_user_is_told_of(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = made(tmp_path / "fastrtps_port7001", b"")

    def refuse(_file: object, mode: int) -> bool:
        if mode & os.O_RDWR:
            raise PermissionError
        return really(_file, mode)

    really = os.open
    monkeypatch.setattr(os, "open", refuse)
    assert list(unfinished(tmp_path)) == [path]
    assert discard_unfinished(tmp_path) == Discarded((), ("fastrtps_port7001",))
    assert path.exists()


def test_where_there_is_no_shared_memory_nothing_is_unfinished(tmp_path: Path) -> None:
    assert discard_unfinished(tmp_path / "none") == Discarded((), ())
