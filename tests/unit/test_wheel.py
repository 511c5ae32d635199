"""What an installed Deck consists of."""

from __future__ import annotations

import zipfile
from pathlib import Path

import pytest
from hatchling.builders.wheel import WheelBuilder

ROOT = Path(__file__).parents[2]
ROOMS = ("cli", "graph", "launcher", "nodes", "profiles", "robot", "text", "tui")


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> zipfile.ZipFile:
    """The wheel of this tree."""
    (built,) = WheelBuilder(str(ROOT)).build(
        directory=str(tmp_path_factory.mktemp("wheel")), versions=["standard"]
    )
    return zipfile.ZipFile(built)


def test_the_wheel_holds_every_file_of_every_room(wheel: zipfile.ZipFile) -> None:
    """Profiles, styles and language catalogues as well as modules."""
    files = (path for room in ROOMS for path in (ROOT / room).rglob("*") if path.is_file())
    ours = {str(path.relative_to(ROOT)) for path in files if "__pycache__" not in path.parts}
    assert ours - set(wheel.namelist()) == set()


def test_the_wheel_holds_nothing_besides(wheel: zipfile.ZipFile) -> None:
    rooms = {name.split("/")[0] for name in wheel.namelist()}
    assert {room for room in rooms if not room.endswith(".dist-info")} == set(ROOMS)


def test_deck_is_a_command(wheel: zipfile.ZipFile) -> None:
    (points,) = (name for name in wheel.namelist() if name.endswith("entry_points.txt"))
    assert "deck = cli:main" in wheel.read(points).decode()


def test_ros_is_asked_of_pypi_only_where_it_is_there(wheel: zipfile.ZipFile) -> None:
    (metadata,) = (name for name in wheel.namelist() if name.endswith("METADATA"))
    lines = wheel.read(metadata).decode().splitlines()
    asked = [line for line in lines if line.startswith("Requires-Dist: ros-jazzy-")]
    assert len(asked) == (ROOT / "pyproject.toml").read_text().count('    "ros-jazzy-')
    marks = ("platform_machine == 'x86_64'", "sys_platform == 'linux'", "extra == 'ros'")
    assert all(mark in line for line in asked for mark in marks)
