"""`deck replay` alone lists the recordings, and opens one by its name."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from cli import main
from cli.recordings import find_recording
from launcher.rundir import new_recording, recordings_path
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


def test_where_there_are_none_it_says_where_they_would_be(
    capsys: pytest.CaptureFixture[str],
) -> None:
    recordings_path().rmdir()
    assert main(["replay"]) == 0
    (line,) = lines(capsys)
    assert line.startswith(f"no recordings in {recordings_path()}: F6")


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


def test_topics_that_said_nothing_are_counted_as_the_end_of_a_recording_counts_them(
    capsys: pytest.CaptureFixture[str],
) -> None:
    path = write_bag(recordings_path() / "walk", seconds=75) / "metadata.yaml"
    silent = re.sub(r"- message_count: \d+\n", "- message_count: 0\n", path.read_text())
    assert "- message_count: 0" in silent
    path.write_text(silent)
    assert main(["replay"]) == 0
    assert lines(capsys)[1].split()[4] == "3"


@pytest.mark.parametrize(
    "metadata", [None, "nonsense", "rosbag2_bagfile_information: {duration: 1}"]
)
def test_one_without_its_metadata_is_listed_with_a_word(
    metadata: str | None, capsys: pytest.CaptureFixture[str]
) -> None:
    bag = write_bag(recordings_path() / "cut", seconds=1)
    if metadata is None:
        (bag / "metadata.yaml").unlink()
    else:
        (bag / "metadata.yaml").write_text(metadata)
    assert main(["replay"]) == 0
    _head, row, trouble, _last = lines(capsys)
    assert row.startswith("cut ")
    assert trouble.strip() == "its metadata.yaml is missing or damaged"


def test_one_that_cannot_be_read_is_listed_with_a_word_and_without_its_figures(
    capsys: pytest.CaptureFixture[str],
) -> None:
    write_bag(recordings_path() / "walk", seconds=1)
    (recordings_path() / "walk" / "walk.mcap").write_bytes(b"")
    (recordings_path() / "other.mcap").write_text("hello")
    cut = write_bag(recordings_path() / "cut", seconds=1) / "cut.mcap"
    os.truncate(cut, cut.stat().st_size - 1)
    assert main(["replay"]) == 0
    _head, *rows, _last = lines(capsys)
    told = dict(zip((row.split()[0] for row in rows[::2]), map(str.strip, rows[1::2]), strict=True))
    assert told == {
        "walk": "walk.mcap is empty, nothing was written to it",
        "other.mcap": "other.mcap is not an MCAP file",
        "cut": "cut.mcap has no end: it is being written, or was cut short",
    }
    assert all("–" in row for row in rows[::2])


def test_a_name_is_found_there_and_a_path_goes_before_it(tmp_path: Path) -> None:
    there = write_bag(recordings_path() / "walk", seconds=1)
    assert find_recording("walk") == there
    here = write_bag(tmp_path / "walk", seconds=1)
    assert find_recording("walk").resolve() == here


@pytest.mark.parametrize("typed", ["09-brain", "9-brain-2026-11-23-12-00-00"])
def test_a_name_that_is_not_there_suggests_the_one_that_was_meant(
    typed: str, capsys: pytest.CaptureFixture[str]
) -> None:
    write_bag(recordings_path() / "09-brain-2026-11-23-12-00-00", seconds=1)
    assert main(["replay", typed]) == 2
    said = capsys.readouterr().err
    assert f"{typed}: there is no such file or folder here or in {recordings_path()}" in said
    assert "did you mean 09-brain-2026-11-23-12-00-00?" in said


def test_a_new_one_is_named_by_what_runs(tmp_path: Path) -> None:
    for what in ("09-brain", "/home/me/profiles/09-brain"):
        path = new_recording(what)
        assert path.parent == recordings_path() == tmp_path / "recordings"
        assert path.name.startswith("09-brain-2")


def test_without_a_setting_they_are_in_the_home_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("DECK_RECORDINGS_DIR")
    monkeypatch.setenv("HOME", str(tmp_path))
    assert recordings_path() == tmp_path / "deck-recordings"


@pytest.mark.parametrize("option", [["--motion"], ["--domain", "5"]])
def test_options_of_publishing_are_refused_without_it(
    option: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["replay", *option]) == 2
    assert "only work with --publish" in capsys.readouterr().err
