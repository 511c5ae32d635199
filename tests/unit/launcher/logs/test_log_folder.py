"""The logs of old runs go by the mark that Deck has made, and nothing goes without it."""

from __future__ import annotations

import json
import os
from typing import TYPE_CHECKING

import pytest

from launcher.logs.folder import MARK, make_log_folder, prune_runs
from launcher.run_id import new_run_id

if TYPE_CHECKING:
    from pathlib import Path

LOGS = ("deck", "sonar")


def run(folder: Path, name: str) -> Path:
    """A run that is over, with its logs."""
    path = folder / name
    make_log_folder(path, LOGS)
    for log in ("deck.log", "sonar.log", "sonar.log.1", "sonar.log.3"):
        (path / log).write_text("a line")
    return path


def names(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


def test_logs_of_old_runs_go_and_those_of_running_ones_stay(tmp_path: Path) -> None:
    running = new_run_id()
    for name in (*(f"202601{day}-1-1-1" for day in range(10, 20)), running):
        run(tmp_path, name)
    prune_runs(tmp_path, keep=3)
    assert names(tmp_path) == sorted(
        ["20260117-1-1-1", "20260118-1-1-1", "20260119-1-1-1", running]
    )
    prune_runs(tmp_path / "nothing")


def test_what_carries_no_mark_or_that_of_another_stays(tmp_path: Path) -> None:
    ours = run(tmp_path, "20260105-1-1-1")
    copy = tmp_path / "20260104-copy"
    copy.mkdir()
    (copy / MARK).write_text((ours / MARK).read_text())
    (copy / "sonar.log").write_text("kept by a person")
    broken = tmp_path / "20260103-broken"
    broken.mkdir()
    (broken / MARK).write_text("[1, 2]")
    (tmp_path / "20260102-plain").mkdir()
    (tmp_path / "20260101-link").symlink_to(ours)
    prune_runs(tmp_path, keep=0)
    assert names(tmp_path) == [
        *("20260101-link", "20260102-plain", "20260103-broken", "20260104-copy")
    ]
    assert names(copy) == [MARK, "sonar.log"]


def test_what_a_person_has_saved_beside_the_logs_stays(tmp_path: Path) -> None:
    ours = run(tmp_path, "20260105-1-1-1")
    for name in ("deck-20260105-120000.log", "notes.txt"):
        (ours / name).write_text("mine")
    prune_runs(tmp_path, keep=0)
    assert names(ours) == ["deck-20260105-120000.log", "notes.txt"]


def test_a_mark_leads_nowhere_else(tmp_path: Path) -> None:
    """It says which files go: none outside its folder, and no target of a link."""
    precious = tmp_path / "precious.log"
    precious.write_text("mine")
    ours = run(tmp_path / "runs", "20260105-1-1-1")
    mark = {"run": ours.name, "logs": ["../../precious", str(tmp_path / "precious"), "sonar"]}
    (ours / MARK).write_text(json.dumps(mark))
    (ours / "sonar.log").unlink()
    (ours / "sonar.log").symlink_to(precious)
    prune_runs(tmp_path / "runs", keep=0)
    assert precious.read_text() == "mine"


def test_a_folder_that_is_there_is_not_taken_for_a_run(tmp_path: Path) -> None:
    (tmp_path / "run").mkdir()
    with pytest.raises(FileExistsError):
        make_log_folder(tmp_path / "run", LOGS)
    assert list((tmp_path / "run").iterdir()) == []


def test_a_mark_that_never_ends_delays_nobody(tmp_path: Path) -> None:
    (tmp_path / "run").mkdir()
    os.mkfifo(tmp_path / "run" / MARK)
    prune_runs(tmp_path, keep=0)
    assert names(tmp_path / "run") == [MARK]
