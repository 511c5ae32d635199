"""The temporary folder of a viewer: nothing of it stays, even if its process is killed."""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

from view.own_folder import PREFIX, OwnFolder

KEEP = """
import sys, tempfile
tempfile.tempdir = sys.argv[1]
from view.own_folder import OwnFolder
folder = OwnFolder()
(folder.path / "log").write_text("x")
print(folder.path, flush=True)
sys.stdin.read()
"""


@pytest.fixture(autouse=True)
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    return tmp_path


def test_it_goes_with_all_that_is_in_it(place: Path) -> None:
    with OwnFolder() as folder:
        (folder.path / "rerun").mkdir()
        (folder.path / "rerun" / "analytics.json").write_text("{}")
        assert list(place.iterdir()) == [folder.path]
    assert list(place.iterdir()) == []


def test_the_next_one_removes_that_of_a_killed_process_but_of_no_living_one(place: Path) -> None:
    command = [sys.executable, "-c", KEEP, str(place)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as other:
        assert other.stdout is not None
        theirs = Path(other.stdout.readline().decode().strip())
        with OwnFolder() as mine:
            assert sorted(place.iterdir()) == sorted([theirs, mine.path])
        other.kill()
        other.wait()
    assert (theirs / "log").exists()
    with OwnFolder() as mine:
        assert list(place.iterdir()) == [mine.path]


def test_what_only_has_such_a_name_stays(place: Path) -> None:
    (place / "precious").mkdir()
    (place / "precious" / "data").write_text("x")
    link, file = place / f"{PREFIX}link", place / f"{PREFIX}file"
    link.symlink_to(place / "precious")
    file.write_text("x")
    with OwnFolder():
        pass
    assert sorted(place.iterdir()) == sorted([file, link, place / "precious"])
    assert (place / "precious" / "data").exists()
