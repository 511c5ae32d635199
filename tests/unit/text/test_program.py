"""What Deck prints to be typed can be typed, whether or not a shell would find it."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from text.output import say_error
from text.program import deck_command


@pytest.fixture
def own(tmp_path: Path) -> Path:
    """An installed Deck, in a folder with a blank in its name."""
    program = tmp_path / "my tools" / "bin" / "deck"
    program.parent.mkdir(parents=True)
    program.touch(mode=0o755)
    return program


def test_a_program_that_is_not_on_the_path_is_called_by_its_own(
    own: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys, "argv", ["my tools/bin/deck", "new", "1"])
    monkeypatch.chdir(own.parents[2])
    monkeypatch.setenv("PATH", "/usr/bin")
    assert deck_command() == f"'{own}'"
    say_error("nothing runs; `deck up PROFILE` starts a profile")
    assert capsys.readouterr().err == f"nothing runs; `'{own}' up PROFILE` starts a profile\n"
    monkeypatch.setenv("PATH", f"/usr/bin:{own.parent}")
    assert deck_command() == "deck"


@pytest.mark.parametrize("program", ["deck", "/usr/lib/pytest/__main__.py", ""])
def test_without_a_path_of_its_own_it_is_called_by_its_name(program: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "argv", [program])
    assert deck_command() == "deck"
