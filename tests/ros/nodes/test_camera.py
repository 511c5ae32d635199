"""The camera: real video files, streams that die and come back, and what is no camera."""

from __future__ import annotations

import signal
import time
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from sensor_msgs.msg import Image

from tests.ros.films import HEIGHT, WIDTH, Stream, write_film
from tests.ros.node_process import NodeProcess
from tests.ros.peer import Peer
from tests.waiting import wait_until

if TYPE_CHECKING:
    from pathlib import Path

pytestmark = pytest.mark.nightly

CAMERA = "/camera/color/image_raw"


def camera(domain: int, source: object, **params: object) -> NodeProcess:
    small = {"source": source, "width": WIDTH, "height": HEIGHT, "rate": 50, **params}
    return NodeProcess("nodes.camera", domain, params=small)


def blue_of(message: Image) -> int:
    return int(np.frombuffer(message.data, np.uint8)[0])


def seconds(message: Image) -> float:
    return float(message.header.stamp.sec + message.header.stamp.nanosec / 1e9)


def wait_told(told: list[DiagnosticArray], level: bytes, words: str) -> dict[str, str]:
    def newest() -> DiagnosticStatus | None:
        status = told[-1].status[0] if told else None
        return status if status and status.level == level and words in status.message else None

    status = wait_until(newest, f"{words!r} on /diagnostics")
    return {item.key: item.value for item in status.values}


def test_a_film_is_shown_at_the_pace_asked_for_and_begins_anew(
    peer: Peer, ros_domain: int, tmp_path: Path
) -> None:
    path = tmp_path / "film.avi"
    write_film(path)
    told = peer.hear("/diagnostics", DiagnosticArray)
    pictures = peer.hear(CAMERA, Image)
    with NodeProcess("nodes.camera", ros_domain, params={"source": path}) as node:
        node.wait_for_words("publishes 640x480 bgr8", f"The camera is {path}")
        wait_until(lambda: len(pictures) > 15, "pictures")
        first = pictures[0]
        assert (first.width, first.height, first.step, first.encoding) == (640, 480, 1920, "bgr8")
        assert first.header.frame_id == "camera_color_optical_frame"
        shown = [blue_of(message) for message in pictures]
        assert any(later < earlier for earlier, later in pairwise(shown))
        assert max(shown) - min(shown) > 100
        red = int(np.frombuffer(first.data, np.uint8)[2])
        assert red == pytest.approx(255 - blue_of(first), abs=8)
        # Of 50 pictures a second 10 are taken.
        assert seconds(pictures[15]) - seconds(first) > 1.3
        values = wait_told(told, DiagnosticStatus.OK, "connected to")
        assert (values["port"], values["connected"]) == (str(path), "true")
        assert node.output.count("The camera is") == 1
        node.send(signal.SIGINT)
        assert node.wait() == 0
        assert "Traceback" not in node.output


def test_a_film_ends_if_it_shall_not_begin_anew(
    peer: Peer, ros_domain: int, tmp_path: Path
) -> None:
    path = tmp_path / "film.avi"
    write_film(path, pictures=5)
    told = peer.hear("/diagnostics", DiagnosticArray)
    with camera(ros_domain, path, loop=False) as node:
        node.wait_for_words("is at its end")
        values = wait_told(told, DiagnosticStatus.OK, "is at its end")
        assert values["connections"] == "1"


def test_what_is_no_film_is_told_and_the_film_is_shown_once_it_is_there(
    peer: Peer, ros_domain: int, tmp_path: Path
) -> None:
    path = tmp_path / "film.avi"
    pictures = peer.hear(CAMERA, Image)
    told = peer.hear("/diagnostics", DiagnosticArray)
    with camera(ros_domain, path) as node:
        node.wait_for_words(f"Cannot open {path}: no such file")
        path.write_bytes(b"no video " * 1000)
        wait_told(told, DiagnosticStatus.ERROR, "OpenCV finds no video in it")
        whole = tmp_path / "whole.avi"
        write_film(whole)
        data = whole.read_bytes()
        # Its beginning alone opens, but has no picture in it.
        path.write_bytes(data[:6000])
        path.write_bytes(data[: len(data) * 3 // 4])
        wait_until(lambda: len(pictures) > 30, "pictures of a film that was cut short")
        assert 100 < max(map(blue_of, pictures)) < 230
        assert "Traceback" not in node.output


def test_what_is_no_camera_is_told_with_the_mend(peer: Peer, ros_domain: int) -> None:
    told = peer.hear("/diagnostics", DiagnosticArray)
    with camera(ros_domain, "/dev/null") as node:
        node.wait_for_words("it gives no pictures", "v4l2-ctl --list-devices")
        wait_told(told, DiagnosticStatus.ERROR, "it gives no pictures")
        node.send(signal.SIGTERM)
        assert node.wait() == 0
        assert "Traceback" not in node.output
        assert "VIDEOIO" not in node.output


def test_a_stream_dies_and_comes_back(peer: Peer, ros_domain: int) -> None:
    pictures = peer.hear(CAMERA, Image)
    told = peer.hear("/diagnostics", DiagnosticArray)
    with Stream() as stream:
        node = camera(ros_domain, stream.url)
        wait_until(lambda: len(pictures) > 5, "pictures")
    with node:
        node.wait_for_words(f"Lost {stream.url}")
        wait_told(told, DiagnosticStatus.ERROR, "nothing answers there")
        pictures.clear()
        with Stream(stream.port):
            wait_until(lambda: len(pictures) > 5, "pictures again")
            assert int(wait_told(told, DiagnosticStatus.OK, "connected to")["reconnects"]) >= 1
        assert "Traceback" not in node.output


@pytest.mark.parametrize("pictures", [0, 3])
def test_a_read_that_blocks_does_not_hold_up_the_end(
    peer: Peer, ros_domain: int, pictures: int
) -> None:
    told = peer.hear("/diagnostics", DiagnosticArray)
    with Stream(pictures=pictures) as stream, camera(ros_domain, stream.url) as node:
        wait_until(stream.asked.is_set, "a request")
        if pictures:
            node.wait_for_words("is open, but no picture came for 2 s")
            wait_told(told, DiagnosticStatus.ERROR, "no picture came for 2 s")
        began_s = time.monotonic()
        node.send(signal.SIGTERM)
        assert node.wait() == 0
        # A second by itself, and what a busy machine adds; the read would take five.
        assert time.monotonic() - began_s < 4.0
        assert "Traceback" not in node.output
