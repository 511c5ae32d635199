"""Where an emergency stop is kept: by Deck's own variable, else where the desktop keeps state."""

from pathlib import Path

import pytest

from robot.safety.stop_place import stop_place


def test_the_folder_of_a_stop(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    monkeypatch.setenv("DECK_STATE_DIR", str(tmp_path / "own"))
    assert stop_place(7) == tmp_path / "own/stops/7"
    monkeypatch.delenv("DECK_STATE_DIR")
    assert stop_place(7) == tmp_path / "state/deck/stops/7"
    monkeypatch.delenv("XDG_STATE_HOME")
    assert stop_place(7) == tmp_path / ".local/state/deck/stops/7"
