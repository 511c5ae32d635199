"""What is graded hides nothing of what it takes, and leaves no folder behind."""

from __future__ import annotations

import os
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest

from course.grade import limits
from course.grade.limits import Taken, taken
from course.grade.removal import remove_tree
from text.i18n import localized

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

DEEP = """
import os
for _ in range(3000):
    os.mkdir("f" * 200)
    os.chdir("f" * 200)
open("file", "w").write("text")
"""
"""A path longer than any call takes."""
UNLINKED = """
import os
with open("file", "wb") as file:
    file.write(bytes(3 << 20))
    file.flush()
    os.unlink("file")
    print(flush=True)
    os.read(0, 1)
"""
SHARED = """
import mmap, os
with mmap.mmap(-1, 64 << 20) as memory:
    memory.write(bytes(64 << 20))
    print(flush=True)
    os.read(0, 1)
"""


@pytest.fixture(params=[UNLINKED, SHARED], ids=["unlinked", "shared"])
def at_work(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Taken]:
    """What is seen of a process, which descends from this one."""
    command = [sys.executable, "-c", request.param]
    with subprocess.Popen(
        command, cwd=tmp_path, stdin=subprocess.PIPE, stdout=subprocess.PIPE
    ) as process:
        assert process.stdout is not None
        process.stdout.readline()
        yield taken(os.getpid(), [tmp_path])
        process.communicate(b"\n")


def test_memory_and_files_that_have_no_name_count(at_work: Taken) -> None:
    assert at_work.disk_bytes >= 3 << 20 or at_work.memory_bytes >= 64 << 20


def test_memory_that_is_shared_counts_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    text = SHARED.replace("print(", "os.fork(); sum(memory[::4096]); print(")
    with subprocess.Popen(
        [sys.executable, "-c", text], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    ) as process:
        assert process.stdout is not None
        # The child of it, too.
        for _ in range(2):
            process.stdout.readline()
        much = taken(os.getpid(), [tmp_path]).memory_bytes
        monkeypatch.setattr(limits, "MEMORY_BYTES", 64 << 20)
        exact = taken(os.getpid(), [tmp_path]).memory_bytes
        process.communicate(b"\n\n")
    assert 64 << 20 <= exact <= much - (50 << 20)


def test_folders_that_cannot_be_looked_into_end_it(tmp_path: Path) -> None:
    subprocess.run([sys.executable, "-c", DEEP], cwd=tmp_path, check=True)
    assert "cannot be looked into" in localized(taken(os.getpid(), [tmp_path]).excess())
    remove_tree(tmp_path)
    assert not tmp_path.exists()


def test_a_folder_that_may_not_be_read_is_no_hiding_place(tmp_path: Path) -> None:
    closed = tmp_path / "closed"
    closed.mkdir()
    (closed / "file").write_text("text")
    closed.chmod(0o300)
    if not os.access(closed, os.R_OK):
        assert "closed" in localized(taken(os.getpid(), [tmp_path]).excess())
    remove_tree(tmp_path)
    assert not tmp_path.exists()


def test_many_files_end_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(limits, "FILES", 5)
    for number in range(7):
        (tmp_path / str(number)).touch()
    assert "more than 5 files" in localized(taken(os.getpid(), [tmp_path]).excess())


def test_what_a_link_leads_to_stays(tmp_path: Path) -> None:
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "file").write_text("text")
    (tmp_path / "theirs").mkdir()
    (tmp_path / "theirs" / "link").symlink_to(tmp_path / "mine")
    remove_tree(tmp_path / "theirs")
    assert not (tmp_path / "theirs").exists()
    assert (tmp_path / "mine" / "file").read_text() == "text"
