"""What is said where a viewer is not installed."""

from __future__ import annotations

from importlib.machinery import ModuleSpec

import pytest

from cli.main import main
from view import installed
from view.faults import ViewError


@pytest.fixture
def _nothing_installed(monkeypatch: pytest.MonkeyPatch) -> None:
    def find(name: str) -> ModuleSpec | None:
        del name
        return None

    monkeypatch.setattr(installed, "find_spec", find)
    monkeypatch.setattr("shutil.which", find)


@pytest.mark.usefixtures("_nothing_installed")
@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["view"], "Rerun is not installed; to install it: make view"),
        (["foxglove"], "Foxglove is not installed; to install it: make view"),
        (["view", "--rviz"], "rviz2 is not on the PATH"),
    ],
)
def test_the_command_says_how_to_get_it(
    words: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([*words, "--domain", "9", "--lang", "en"]) == 2
    assert said in capsys.readouterr().err


@pytest.mark.usefixtures("_nothing_installed")
def test_an_old_python_is_told_of(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.version_info", (3, 10, 4))
    with pytest.raises(ViewError, match=r"3\.11 or newer, and this is 3\.10"):
        installed.rerun_program()


@pytest.mark.usefixtures("_nothing_installed")
def test_an_installed_deck_names_its_own_pip(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(installed, "CHECKOUT", installed.CHECKOUT.with_name("no Makefile"))
    assert installed.how_to_install().endswith("-m pip install 'deck-robot[view]'")
