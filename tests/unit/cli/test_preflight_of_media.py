"""Camera and sound before a start: a picture, and devices by their names."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest

from cli.doctor import Level
from cli.preflight import examine, media
from tests.unit.cli.test_preflight_of_devices import robot


def test_a_camera_is_asked_for_a_picture(tmp_path: Path) -> None:
    path = tmp_path / "film.avi"
    film = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*"MJPG"), 10, (320, 240))
    film.write(np.zeros((240, 320, 3), np.uint8))
    film.release()
    (found,) = examine(robot(camera={"kind": "camera", "source": str(path)}), list)
    assert (found.level, found.text) == (Level.OK, f"camera {path}: a picture of 320x240")


def test_cameras_that_are_missing_or_none(tmp_path: Path) -> None:
    (tmp_path / "note.txt").write_text("no film")
    (none,) = examine(robot(eye={"kind": "camera", "source": "77"}), list)
    assert none.level is Level.FAIL
    assert "eye /dev/video77: there is no such camera" in none.text
    assert "DECK_EYE_SOURCE=" in none.fix
    (other,) = examine(robot(eye={"kind": "camera", "source": str(tmp_path / "note.txt")}), list)
    assert other.level is Level.FAIL
    assert "it delivers no picture" in other.text


CARDS = '[["USB Microphone, Audio"], ["HDMI", "MAX98357A"]]'


@pytest.mark.parametrize(
    ("cards", "settings", "level", "words"),
    [
        (CARDS, {}, Level.OK, "USB Microphone, Audio, HDMI"),
        (CARDS, {"microphone": "usb", "speaker": "1"}, Level.OK, "MAX98357A"),
        (CARDS, {"microphone": "none", "speaker": "none"}, Level.OK, "switched off"),
        (CARDS, {"microphone": "MAX"}, Level.FAIL, "not found: microphone MAX; sound devices: USB"),
        (CARDS, {"speaker": "2"}, Level.FAIL, "not found: loudspeaker 2;"),
        ("[[], []]", {}, Level.FAIL, "not found: microphone, loudspeaker; sound devices: none"),
        ("", {}, Level.FAIL, "sound devices: none"),
        ("no JSON", {}, Level.FAIL, "sound devices: none"),
    ],
)
def test_microphones_and_loudspeakers(
    cards: str,
    settings: dict[str, object],
    level: Level,
    words: str,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(media, "_run", lambda *_: cards)
    (found,) = examine(robot(sound={"kind": "sound", **settings}), list)
    assert found.level is level
    assert words in found.text
    assert (found.level is Level.OK) is (found.fix == "")
