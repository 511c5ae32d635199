"""What is kept of logs: in memory, in files, in folders."""

from __future__ import annotations

from itertools import islice
from pathlib import Path

import pytest

from launcher.logs import files as logs_files
from launcher.logs.files import MARK, LogFiles, make_log_folder, prune_runs
from launcher.logs.ring import BLOCK_LINES, LogRing
from launcher.run_id import new_run_id
from launcher.status import LogLine, Severity
from text.sentences import Words, say

MANY = 5 * BLOCK_LINES


def numbered(number: int) -> LogLine:
    text = f"Препятствие в {number / 100:.2f} м\udcff"
    return LogLine("sonar", number, 1.7e9 + number / 3, Severity.WARN, text, "sonar.gate", "stdout")


def test_lines_come_back_as_they_were() -> None:
    lines = [numbered(number) for number in range(MANY)]
    words = say("{count} nodes", count=4)
    lines[3] = LogLine("deck", 3, 0.1, Severity.INFO, words, source="deck")
    kept = LogRing()
    for line in lines:
        kept.append(line)
    assert len(kept) == MANY
    again = list(reversed(kept))[::-1]
    assert again == lines
    assert isinstance(again[3].text, Words)
    assert list(islice(reversed(kept), 3)) == lines[:-4:-1]


def fill(ring: LogRing, count: int, text: str = "x") -> None:
    for _line in range(count):
        ring.append(LogLine("sonar", ring.last_seq + 1, 0.0, Severity.INFO, text))


def test_the_oldest_lines_go_when_there_are_too_many() -> None:
    ring = LogRing(max_lines=10)
    fill(ring, 25)
    assert [line.seq for line in ring.newest(100)] == list(range(16, 26))


def test_a_reader_gets_what_came_after_what_it_has_seen() -> None:
    ring = LogRing()
    fill(ring, 9)
    assert [line.seq for line in ring.after(6, limit=100, max_chars=10_000)] == [7, 8, 9]
    assert ring.after(9, limit=100, max_chars=10_000) == []


def test_a_reader_far_behind_gets_the_newest_within_its_bounds() -> None:
    ring = LogRing()
    fill(ring, 100, "x" * 100)
    assert [line.seq for line in ring.after(0, limit=5, max_chars=10_000)] == [96, 97, 98, 99, 100]
    assert [line.seq for line in ring.after(0, limit=50, max_chars=250)] == [99, 100]


def complain(reason: str) -> None:
    pytest.fail(reason)


def test_a_full_file_is_rotated_and_the_oldest_goes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(logs_files, "MAX_FILE_BYTES", 10)
    files = LogFiles(tmp_path, complain)
    for number in range(6):
        files.write("sonar", b"line %d..\n" % number)
    files.close()
    left = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    assert left == {
        "sonar.log": b"line 5..\n",
        "sonar.log.1": b"line 4..\n",
        "sonar.log.2": b"line 3..\n",
        "sonar.log.3": b"line 2..\n",
    }


def test_a_disk_that_is_too_slow_loses_bytes_and_says_how_many(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(logs_files, "MAX_QUEUED_BYTES", 10)
    files = LogFiles(tmp_path, complain)
    files._queued = 5  # As if the writing thread had not come to it yet.
    files.write("sonar", b"123456789\n")
    files._queued = 0
    files.write("sonar", b"after\n")
    files.close()
    text = (tmp_path / "sonar.log").read_bytes()
    assert text == b"[deck: 10 bytes left out, the disk is slow]\nafter\n"


def test_a_file_that_cannot_be_written_is_told_of_once(tmp_path: Path) -> None:
    (tmp_path / "run").write_text("not a folder")
    reasons: list[str] = []
    files = LogFiles(tmp_path / "run", reasons.append)
    files.write("sonar", b"one\n")
    files.write("sonar", b"two\n")
    files.close()
    assert len(reasons) == 1


LOGS = ("deck", "sonar")


def run(folder: Path, name: str) -> Path:
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
    assert names(tmp_path) == sorted(["20260117-1-1-1", "20260118-1-1-1", "20260119-1-1-1", running])
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
    assert names(tmp_path) == [*("20260101-link", "20260102-plain", "20260103-broken", "20260104-copy")]
    assert names(copy) == [MARK, "sonar.log"]
