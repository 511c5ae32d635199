"""Where a run is kept: as told, else in the login's own folder, else in one of the user's."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from text.run_path import run_path


def test_what_is_told_comes_first(tmp_path: Path) -> None:
    assert run_path({"DECK_RUN_DIR": "/r", "XDG_RUNTIME_DIR": str(tmp_path)}) == Path("/r")


def test_the_folder_of_the_login_is_taken_while_it_is_there(tmp_path: Path) -> None:
    assert run_path({"XDG_RUNTIME_DIR": str(tmp_path)}) == tmp_path / "deck"
    gone = run_path({"XDG_RUNTIME_DIR": str(tmp_path / "gone")})
    assert gone == run_path({}) == Path(f"/tmp/deck-{os.getuid()}")


def test_the_folder_of_somebody_elses_login_is_not_taken(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(os, "getuid", lambda: 4_000_000)
    assert run_path({"XDG_RUNTIME_DIR": str(tmp_path)}) == Path("/tmp/deck-4000000")
