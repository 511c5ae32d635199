"""A camera whose pictures are numbered, and the viewer that shows it, for a whole module."""

from __future__ import annotations

import os
import sys
import threading
from contextlib import ExitStack
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import pytest
from rclpy.publisher import Publisher
from sensor_msgs.msg import Image

from tests.conftest import take
from tests.deck_process import DeckProcess
from tests.ros.peer import Peer
from view.place import OLDEST

if TYPE_CHECKING:
    from collections.abc import Iterator

    from tests.domains import DomainPool

collect_ignore = [] if sys.version_info >= OLDEST else ["test_page_in_a_browser.py", "test_view_process.py"]
"""Rerun has no wheels for older Pythons, and `deck view` says so."""
WIDTH, HEIGHT = 160, 120
RED = (255, 0, 0)
PERIOD_S = 0.1
CAMERA = "/camera/color/image_raw"


class Camera:
    """Publishes ten pictures a second: red on the left, their number, modulo 256, as a grey."""

    def __init__(self, publisher: Publisher) -> None:
        self.number = 0
        self._publisher = publisher
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Publish no more."""
        self._ending.set()
        self._thread.join()

    def _run(self) -> None:
        while not self._ending.wait(PERIOD_S):
            self.number += 1
            pixels = np.full((HEIGHT, WIDTH, 3), self.number % 256, np.uint8)
            pixels[:, : WIDTH // 2] = RED
            message = Image(width=WIDTH, height=HEIGHT, encoding="rgb8", step=3 * WIDTH)
            message.data = pixels.tobytes()
            self._publisher.publish(message)


class Shown(NamedTuple):
    """The viewer at work."""

    process: DeckProcess
    url: str
    camera: Camera
    peer: Peer
    domain: int


@pytest.fixture(scope="module")
def shown(domain_pool: DomainPool) -> Iterator[Shown]:
    """A camera, and `deck view --web` on it."""
    with ExitStack() as stack, pytest.MonkeyPatch.context() as environment:
        for name in ("SSH_CONNECTION", "DISPLAY", "WAYLAND_DISPLAY"):
            environment.delenv(name, raising=False)
        domain = take(domain_pool)
        stack.callback(domain_pool.let_go, domain)
        peer = stack.enter_context(Peer(domain, "camera"))
        camera = Camera(peer.publisher(CAMERA, Image))
        stack.callback(camera.close)
        assert "SSH_CONNECTION" not in os.environ
        process = DeckProcess("view", "--web", "--domain", str(domain), "--lang", "en")
        stack.callback(process.close)
        line = process.said("in a browser: ")
        url = line.partition("in a browser: ")[2].partition(";")[0]
        yield Shown(process, url, camera, peer, domain)
