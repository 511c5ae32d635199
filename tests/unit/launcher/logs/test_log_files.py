"""Log files hold every byte, within bounds, and nobody waits for a disk."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from launcher.logs import files as logs_files
from launcher.logs.files import LogFiles

if TYPE_CHECKING:
    from pathlib import Path


def complain(reason: str) -> None:
    pytest.fail(reason)


def test_bytes_are_written_as_they_are(tmp_path: Path) -> None:
    files = LogFiles(tmp_path / "run", complain)
    files.write("sonar", b"\x1b[31mone\n")
    files.write("camera", b"two\n")
    files.write("sonar", b"\xff\n")
    files.close()
    assert (tmp_path / "run" / "sonar.log").read_bytes() == b"\x1b[31mone\n\xff\n"
    assert (tmp_path / "run" / "camera.log").read_bytes() == b"two\n"


def test_a_full_file_is_rotated_and_the_oldest_goes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
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
