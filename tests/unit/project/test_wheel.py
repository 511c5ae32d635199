"""What an installed Deck consists of, and that it takes no name but its own."""

from __future__ import annotations

import re
import zipfile
from pathlib import Path

import pytest

from tests.installed_wheel import INSIDE, ROOT, Installed, build_wheel

CHANGELOG = ROOT / "CHANGELOG.md"
FOLDERS = (*INSIDE, "bridges", "lessons", "profiles")


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> zipfile.ZipFile:
    return zipfile.ZipFile(build_wheel(tmp_path_factory.mktemp("wheel")))


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Installed:
    """The wheel, installed beside a `graph`, a `text` and the rest that are somebody else's."""
    return Installed(tmp_path_factory.mktemp("installed"))


def record_of(wheel: zipfile.ZipFile) -> list[str]:
    (record,) = (name for name in wheel.namelist() if name.endswith(".dist-info/RECORD"))
    return [line.split(",")[0] for line in wheel.read(record).decode().splitlines()]


def test_the_wheel_holds_every_file_of_every_room(wheel: zipfile.ZipFile) -> None:
    """Profiles, styles and language catalogues as well as modules."""
    files = (path for room in FOLDERS for path in (ROOT / room).rglob("*") if path.is_file())
    ours = {f"deck/{path.relative_to(ROOT)}" for path in files if "__pycache__" not in path.parts}
    assert ours - set(wheel.namelist()) == set()


def test_the_wheel_takes_one_name_in_site_packages(wheel: zipfile.ZipFile) -> None:
    """And a line at the end of the search path: cv_bridge and tf2_ros, if there are no others."""
    names = {Path(name).parts[0] for name in record_of(wheel)}
    last = "deck_robot_bridges.pth"
    assert {name for name in names if not name.endswith(".dist-info")} == {"deck", last}
    assert wheel.read(last).decode() == "deck/bridges\n"


def test_the_version_is_the_newest_of_the_changelog(wheel: zipfile.ZipFile) -> None:
    numbers = re.findall(r"^## \[([\d.]+)\] - \d{4}-\d\d-\d\d$", CHANGELOG.read_text(), re.MULTILINE)
    assert Path(str(wheel.filename)).name.startswith(f"deck_robot-{numbers[0]}-")


def test_an_installed_deck_goes_beside_packages_of_the_same_names(installed: Installed) -> None:
    assert installed.deck("--version").startswith("deck ")
    assert installed.python("-m", "deck", "--version") == installed.deck("--version")
    assert "01-hello" in installed.deck("list", "--lang", "en")
    assert "узлы:" in installed.deck("list", "--lang", "ru")
    installed.deck("check", "09-brain")
    assert not installed.imported.exists()


@pytest.mark.parametrize("room", INSIDE)
def test_the_packages_of_others_stay_theirs(installed: Installed, room: str) -> None:
    """To import Deck's package moves nothing either."""
    program = f"import deck, {room}; print({room}.WHOSE)"
    assert installed.python("-c", program) == "somebody else\n"
    installed.imported.unlink()
