"""Folders to be graded: whose they are, what is read of them, what is put back."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from course.grade import submission
from course.grade.submission import Files, UnreadableError, default_folder, submissions
from launcher.errors import UsageError
from tests.unit.course.grade.made import LESSON


def folder(path: Path, **files: str) -> Path:
    path.mkdir(parents=True)
    for name, text in files.items():
        (path / f"{name}.py").write_text(text)
    return path


def test_learners_of_one_name_are_told_apart(tmp_path: Path) -> None:
    chosen = [folder(tmp_path / group / "anna", mock_sonar="") for group in ("a", "b")]
    assert [one.student for one in submissions(LESSON, chosen)] == ["a/anna", "b/anna"]
    assert [one.student for one in submissions(LESSON, chosen[:1])] == ["anna"]


def test_a_course_folder_stands_for_the_lessons_folder_in_it(tmp_path: Path) -> None:
    inner = folder(tmp_path / "anna" / LESSON.name, mock_sonar="")
    (one,) = submissions(LESSON, [tmp_path / "anna"])
    assert (one.student, one.folder) == ("anna", inner)


def test_what_is_no_folder_or_named_twice_is_refused(tmp_path: Path) -> None:
    there = folder(tmp_path / "anna")
    for wrong in ([tmp_path / "nobody"], [there, tmp_path / "x" / ".." / "anna"]):
        (tmp_path / "x").mkdir(exist_ok=True)
        with pytest.raises(UsageError):
            submissions(LESSON, wrong)


def test_without_a_folder_ones_own_or_this_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    own, here = tmp_path / "own", folder(tmp_path / "here")
    monkeypatch.chdir(here)
    with pytest.raises(UsageError, match="deck new"):
        default_folder(LESSON, own)
    (here / "mock_sonar.py").write_text("")
    assert default_folder(LESSON, own) == here
    assert default_folder(LESSON, folder(own)) == own


def test_links_pipes_and_what_is_not_the_learners_are_not_read(tmp_path: Path) -> None:
    place = folder(tmp_path / "anna", mine="1")
    (place / "secret").symlink_to("/etc/passwd")
    (place / "round").symlink_to(place)
    os.mkfifo(place / "pipe")
    folder(place / "__pycache__", cached="")
    folder(place / ".git", history="")
    folder(place / "parts", part="2")
    files = Files.read(place)
    assert files.contents == {Path("mine.py"): b"1", Path("parts/part.py"): b"2"}
    files.write(tmp_path / "copy")
    assert (tmp_path / "copy/parts/part.py").read_text() == "2"


def test_a_gigabyte_is_not_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(submission, "MOST_BYTES", 1000)
    place = folder(tmp_path / "anna", mine="x" * 400)
    Files.read(place)
    with (place / "huge").open("wb") as file:
        file.truncate(10**12)
    with pytest.raises(UnreadableError, match="right one"):
        Files.read(place)


def test_mode_time_and_attributes_are_put_back(tmp_path: Path) -> None:
    place = folder(tmp_path / "anna", mine="text", other="text")
    (place / "inner").mkdir()
    (place / "inner" / "more.py").write_text("text")
    files = Files.read(place)
    before = {path: path.stat() for path in place.rglob("*.py")}
    (place / "mine.py").chmod(0)
    (place / "inner").chmod(0)
    os.utime(place / "other.py", (1, 1))
    attributes = _can_mark(place / "other.py")
    assert sorted(files.put_back()) == ["inner", "mine.py", "other.py"]
    for path, info in before.items():
        now = path.stat()
        assert (now.st_mode, now.st_mtime_ns) == (info.st_mode, info.st_mtime_ns), path
    assert attributes is False or os.listxattr(place / "other.py") == []
    assert files.put_back() == []


def _can_mark(path: Path) -> bool:
    """Add an attribute, where the file system has them."""
    try:
        os.setxattr(path, "user.deck", b"x")
    except OSError:
        return False
    return True


def test_what_was_changed_is_put_back(tmp_path: Path) -> None:
    place = folder(tmp_path / "anna", mine="1", gone="2", kept="3", linked="4")
    files = Files.read(place)
    (place / "mine.py").write_text("changed")
    (place / "gone.py").unlink()
    (place / "linked.py").unlink()
    outside = tmp_path / "outside"
    outside.write_text("4")
    (place / "linked.py").symlink_to(outside)
    assert sorted(files.put_back()) == ["gone.py", "linked.py", "mine.py"]
    assert Files.read(place).contents == files.contents
    assert outside.read_text() == "4"
    assert files.put_back() == []
