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
    """The wheel of this tree."""
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


def test_the_wheel_holds_the_rooms_and_nothing_besides(wheel: zipfile.ZipFile) -> None:
    inside = {Path(name).parts[1] for name in wheel.namelist() if name.startswith("deck/")}
    assert inside == {*FOLDERS, "__init__.py", "__main__.py", "py.typed"}


def test_the_wheel_speaks_russian(wheel: zipfile.ZipFile) -> None:
    assert "deck/text/locale/ru/LC_MESSAGES/deck.mo" in wheel.namelist()


def test_type_checkers_may_read_it(wheel: zipfile.ZipFile) -> None:
    marked = {name for name in wheel.namelist() if name.endswith("/py.typed")}
    assert marked == {"deck/py.typed", *(f"deck/{room}/py.typed" for room in INSIDE)}


def test_deck_is_a_command(wheel: zipfile.ZipFile) -> None:
    (points,) = (name for name in wheel.namelist() if name.endswith("entry_points.txt"))
    assert "deck = deck:main" in wheel.read(points).decode()


def test_the_version_is_the_newest_of_the_changelog(wheel: zipfile.ZipFile) -> None:
    numbers = re.findall(
        r"^## \[([\d.]+)\] - \d{4}-\d\d-\d\d$", CHANGELOG.read_text(), re.MULTILINE
    )
    assert Path(str(wheel.filename)).name.startswith(f"deck_robot-{numbers[0]}-")


def test_ros_is_asked_of_pypi_only_where_it_is_there(wheel: zipfile.ZipFile) -> None:
    (metadata,) = (name for name in wheel.namelist() if name.endswith("METADATA"))
    lines = wheel.read(metadata).decode().splitlines()
    asked = [line for line in lines if line.startswith("Requires-Dist: ros-jazzy-")]
    assert len(asked) == (ROOT / "pyproject.toml").read_text().count('    "ros-jazzy-')
    marks = ("platform_machine == 'x86_64'", "sys_platform == 'linux'", "extra == 'ros'")
    assert all(mark in line for line in asked for mark in marks)


def test_an_installed_deck_goes_beside_packages_of_the_same_names(installed: Installed) -> None:
    assert installed.deck("--version").startswith("deck ")
    assert installed.python("-m", "deck", "--version") == installed.deck("--version")
    assert "01-hello" in installed.deck("list", "--lang", "en")
    assert "узлы:" in installed.deck("list", "--lang", "ru")
    installed.deck("check", "09-brain")
    assert not installed.imported.exists()


def test_an_installed_deck_brings_cv_bridge(installed: Installed) -> None:
    found = installed.said_by(
        str(installed.bin / "python"), "-c", "import cv_bridge; print(cv_bridge.__file__)"
    )
    assert str(installed.site / "deck" / "bridges") in found


def test_an_installed_deck_uses_its_own_modules(installed: Installed) -> None:
    program = "import deck; deck.enter(); import launcher.errors; print(launcher.errors.__file__)"
    assert installed.python("-c", program).startswith(str(installed.site / "deck" / "launcher"))
    assert not installed.imported.exists()


def test_an_installed_deck_has_the_robot_s_model(installed: Installed) -> None:
    program = """import deck; deck.enter()
from nodes.robot_state_publisher import COURSE_ROBOT
from space.urdf import read_urdf
print(COURSE_ROBOT, read_urdf(COURSE_ROBOT.read_text()).name)"""
    found = installed.python("-c", program)
    assert found.startswith(str(installed.site / "deck" / "robot"))
    assert found.endswith("deck_robot\n")


@pytest.mark.parametrize("room", INSIDE)
def test_the_packages_of_others_stay_theirs(installed: Installed, room: str) -> None:
    """To import Deck's package moves nothing either."""
    program = f"import deck, {room}; print({room}.WHOSE)"
    assert installed.python("-c", program) == "somebody else\n"
    installed.imported.unlink()
