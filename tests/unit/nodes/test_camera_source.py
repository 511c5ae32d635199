"""What a camera's source is by its name, and how pictures of other sizes are fitted."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

from nodes.drivers.camera_source import CameraSource, SourceKind, SourceSetting
from nodes.parts.parameters import BadValueError
from nodes.parts.pictures import fit

if TYPE_CHECKING:
    from pathlib import Path


@pytest.mark.parametrize(
    ("name", "kind", "shown"),
    [
        ("0", SourceKind.DEVICE, "/dev/video0"),
        ("12", SourceKind.DEVICE, "/dev/video12"),
        ("/dev/v4l/by-id/usb-x", SourceKind.DEVICE, "/dev/v4l/by-id/usb-x"),
        ("film.avi", SourceKind.FILE, "film.avi"),
        ("http://pi:8080/x?a=b@c", SourceKind.STREAM, "http://pi:8080/x?a=b@c"),
        ("rtsp://me:secret@pi/x", SourceKind.STREAM, "rtsp://me:***@pi/x"),
        ("rtsp://me:a:b@pi/x", SourceKind.STREAM, "rtsp://me:***@pi/x"),
    ],
)
def test_a_source_is_known_by_its_name(name: str, kind: SourceKind, shown: str) -> None:
    source = CameraSource(name)
    assert (source.kind, str(source)) == (kind, shown)


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("/dev/video99", "no such camera"),
        ("/dev/null", "no pictures"),
        ("/dev/shm", "it is not a camera"),
        ("http://x", "nothing answers"),
    ],
)
def test_why_it_does_not_open_is_told(name: str, words: str) -> None:
    assert words in CameraSource(name).why_not()


def test_files_are_told_apart(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "film"
    assert CameraSource(str(path)).why_not() == "no such file"
    path.touch()
    assert "finds no video" in CameraSource(str(path)).why_not()
    monkeypatch.setattr("nodes.drivers.camera_source.os.access", lambda *_: False)
    assert "chmod" in CameraSource(str(path)).why_not()
    assert "usermod -aG video" in CameraSource("/dev/null").why_not()


def test_a_number_is_taken_for_the_name_of_a_camera() -> None:
    setting = SourceSetting("source", "0", "")
    assert setting.accept(2) == "2"
    assert setting.accept("film.avi") == "film.avi"
    for bad in (-1, True, 1.5, ""):
        with pytest.raises(BadValueError):
            setting.accept(bad)


@pytest.mark.parametrize(
    ("shape", "bars"),
    [((48, 64), (0, 0)), ((24, 32), (0, 0)), ((48, 32), (0, 16)), ((36, 128), (15, 0))],
)
def test_a_picture_of_another_size_gets_bars(shape: tuple[int, int], bars: tuple[int, int]) -> None:
    picture = np.full((*shape, 3), (10, 20, 30), np.uint8)
    into = np.full((48, 64, 3), 99, np.uint8)
    fit(picture, into)
    top, left = bars
    middle = into[top : 48 - top, left : 64 - left]
    assert (middle == (10, 20, 30)).all()
    assert into.sum() == middle.sum()


def test_a_grey_picture_is_taken() -> None:
    into = np.zeros((4, 4, 3), np.uint8)
    for grey in (np.full((4, 4), 7, np.uint8), np.full((8, 8, 1), 7, np.uint8)):
        fit(grey, into)
        assert (into == 7).all()
