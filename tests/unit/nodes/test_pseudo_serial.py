"""The name of an emulated device is taken only where there is none, or one of a device like it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from nodes.simulated.pseudo_terminal import PseudoSerial

if TYPE_CHECKING:
    from pathlib import Path


def test_what_an_earlier_device_has_left_is_replaced(tmp_path: Path) -> None:
    path = tmp_path / "pico"
    path.symlink_to("/dev/pts/4000")
    device = PseudoSerial(path)
    assert str(path.readlink()) != "/dev/pts/4000"
    device.unplug()
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("target", ["precious", "gone", "/dev/ttyACM0"])
def test_a_link_of_somebodys_own_stays(tmp_path: Path, target: str) -> None:
    (tmp_path / "precious").write_text("mine")
    path = tmp_path / "pico"
    path.symlink_to(target)
    with pytest.raises(FileExistsError, match="no device of ours"):
        PseudoSerial(path)
    assert str(path.readlink()) == target
    assert (tmp_path / "precious").read_text() == "mine"


def test_a_file_of_somebodys_own_stays(tmp_path: Path) -> None:
    path = tmp_path / "pico"
    path.write_text("mine")
    with pytest.raises(FileExistsError, match="no device of ours"):
        PseudoSerial(path)
    assert path.read_text() == "mine"
    assert list(tmp_path.iterdir()) == [path]
