"""A profile that is no file that can be read is refused with a word why."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from tests.unit.profile_files import refused, written


def test_a_missing_file_is_told(tmp_path: Path) -> None:
    assert "none.yaml: no such file" in refused(tmp_path / "none.yaml")


def test_a_directory_is_told_with_the_profiles_in_it(tmp_path: Path) -> None:
    written(tmp_path, "nodes: {}", "a.yaml")
    assert "found a directory (it contains: a.yaml)" in refused(tmp_path)


def test_a_pipe_is_not_waited_for(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.yaml")
    assert "not a regular file" in refused(tmp_path / "pipe.yaml")


def test_a_file_without_permission_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = written(tmp_path, "nodes: {}")

    def forbidden(*_args: object, **_options: object) -> None:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(Path, "open", forbidden)
    assert "no permission to read it" in refused(path)


def test_bytes_that_are_not_utf8_are_told_with_their_place(tmp_path: Path) -> None:
    path = tmp_path / "latin.yaml"
    path.write_bytes("nodes: {}\ntitle: Урок".encode("cp1251"))
    assert "latin.yaml:2:8: is not UTF-8: byte 0xd3 (save the file as UTF-8)" in refused(path)


def test_a_huge_file_is_told(tmp_path: Path) -> None:
    path = tmp_path / "huge.yaml"
    path.write_text("#" * 300_000)
    assert "is larger than 256 KiB" in refused(path)
