"""`deck replay` alone lists the recordings, and opens one by its name."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

import pytest

from cli import main
from launcher.rundir import recordings_path
from tests.unit.bags import write_bag
from text.i18n import set_language


@pytest.fixture(autouse=True)
def _elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    monkeypatch.chdir(tmp_path)
    recordings_path().mkdir()
    yield recordings_path()
    set_language("en")


def lines(capsys: pytest.CaptureFixture[str]) -> list[str]:
    return capsys.readouterr().out.splitlines()


def test_they_are_listed_the_newest_first(capsys: pytest.CaptureFixture[str]) -> None:
    for name, at_s in (("old", 1_700_000_000), ("new", 1_700_000_600)):
        write_bag(recordings_path() / name, seconds=75)
        for file in (recordings_path() / name).iterdir():
            os.utime(file, (at_s, at_s))
    (recordings_path() / "notes.txt").write_text("mine")
    (recordings_path() / "empty").mkdir()
    assert main(["replay"]) == 0
    head, new, old, last = lines(capsys)
    assert head.split() == ["NAME", "ENDED", "LENGTH", "TOPICS", "MESSAGES", "SIZE"]
    assert new.split()[:6] == ["new", *new.split()[1:3], "1:15", "3", "753"]
    assert old.split()[0] == "old"
    assert last == f"recordings are in {recordings_path()}; to open one: deck replay NAME"


@pytest.mark.parametrize("typed", ["09-brain", "9-brain-2026-11-23-12-00-00"])
def test_a_name_that_is_not_there_suggests_the_one_that_was_meant(
    typed: str, capsys: pytest.CaptureFixture[str]
) -> None:
    write_bag(recordings_path() / "09-brain-2026-11-23-12-00-00", seconds=1)
    assert main(["replay", typed]) == 2
    said = capsys.readouterr().err
    assert f"{typed}: there is no such file or folder here or in {recordings_path()}" in said
    assert "did you mean 09-brain-2026-11-23-12-00-00?" in said
