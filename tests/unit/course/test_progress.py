"""The progress file: what is noted stays, and what makes no sense costs ticks and nothing else."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from course.progress.files import state_of
from course.progress.progress import Progress, load_progress, noted

LESSON = "02-sonar-safety"


@pytest.mark.parametrize(
    "broken",
    [
        b"",
        b"\xff\xfe",
        b"[1, 2]",
        b'{"lessons": {"02-sonar-safety": {"topic": {"passed"',
        b'{"lessons": [], "last": 7}',
        b'{"lessons": {"02-sonar-safety": {"topic": {"passed": 1, "points": 9999999}}}}',
        b"[" * 100_000,
        b" " * (1 << 21),
    ],
)
def test_a_broken_file_counts_as_nothing_done_and_is_kept_beside_the_next(
    tmp_path: Path, broken: bytes
) -> None:
    path = tmp_path / "progress.json"
    path.write_bytes(broken)
    assert not load_progress(path).passed(LESSON)
    assert noted(LESSON, "rate", {"passed": True, "points": 2}, path).passed(LESSON) == {"rate"}
    assert load_progress(path).points(LESSON, {"rate"}) == 2
    assert path.with_name("progress.json.broken").read_bytes() == broken


def test_a_step_that_makes_no_sense_costs_only_itself(tmp_path: Path) -> None:
    path = tmp_path / "progress.json"
    steps = {"topic": {"passed": True, "points": 2}, "rate": {"passed": "yes"}}
    path.write_text(json.dumps({"lessons": {LESSON: steps}}))
    assert load_progress(path).passed(LESSON) == {"topic"}


def test_a_step_holds_with_the_files_that_it_passed_with(tmp_path: Path) -> None:
    path, file = tmp_path / "progress.json", tmp_path / "mine.py"
    file.write_text("right = 1")
    before = state_of([str(file)])
    noted(LESSON, "rate", {"passed": True, "points": 2, "files": before, "at": 5}, path)
    assert load_progress(path).held(LESSON, before) == {"rate"}
    file.write_text("right = 2")
    after = state_of([str(file)])
    assert load_progress(path).held(LESSON, after) == frozenset()
    assert load_progress(path).step(LESSON, "rate").at == 5
    file.write_text("right = 1")
    assert load_progress(path).held(LESSON, state_of([str(file)])) == {"rate"}


def test_a_deleted_file_is_no_mistake(tmp_path: Path) -> None:
    path = tmp_path / "progress.json"
    assert load_progress(path) == Progress()
    noted(LESSON, path=path)
    assert load_progress(path).last == LESSON
    assert [file.name for file in tmp_path.iterdir()] == ["progress.json"]
