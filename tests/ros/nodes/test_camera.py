"""The camera: a stream over HTTP, as cameras serve it, dies and comes back."""

from __future__ import annotations

import contextlib
import threading
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

import cv2
import numpy as np
import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from numpy.typing import NDArray
from sensor_msgs.msg import Image
from typing_extensions import Self

from tests.ros.node_process import NodeProcess
from tests.ros.peer import Peer
from tests.waiting import wait_until

WIDTH, HEIGHT = 64, 48
_BOUNDARY = "picture"


def picture(blue: int) -> NDArray[np.uint8]:
    """One colour, (rows, columns, 3)."""
    return np.full((HEIGHT, WIDTH, 3), (blue, 0, 255 - blue), np.uint8)


class Stream:
    """Serves Motion JPEG on localhost while it is used in a `with`."""

    def __init__(self, port: int = 0) -> None:
        self._ending = threading.Event()
        stream = self

        class Handler(BaseHTTPRequestHandler):
            def do_GET(self) -> None:
                with contextlib.suppress(OSError):
                    stream._serve(self)

            def log_message(self, *_: object) -> None:
                pass

        self._server = ThreadingHTTPServer(("127.0.0.1", port), Handler)
        self.port = self._server.server_address[1]
        self.url = f"http://127.0.0.1:{self.port}/film.mjpg"
        self._thread = threading.Thread(target=self._server.serve_forever, args=(0.02,))

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._ending.set()
        self._server.shutdown()
        self._thread.join()
        self._server.server_close()

    def _serve(self, handler: BaseHTTPRequestHandler) -> None:
        handler.send_response(200)
        handler.send_header("Content-Type", f"multipart/x-mixed-replace; boundary={_BOUNDARY}")
        handler.end_headers()
        number = 0
        while not self._ending.wait(0.02):
            _made, jpeg = cv2.imencode(".jpg", picture(number % 256))
            head = f"--{_BOUNDARY}\r\nContent-Type: image/jpeg\r\nContent-Length: {len(jpeg)}"
            handler.wfile.write(f"{head}\r\n\r\n".encode() + jpeg.tobytes() + b"\r\n")
            number += 1


pytestmark = pytest.mark.nightly

CAMERA = "/camera/color/image_raw"


def camera(domain: int, source: object, **params: object) -> NodeProcess:
    small = {"source": source, "width": WIDTH, "height": HEIGHT, "rate": 50, **params}
    return NodeProcess("nodes.camera", domain, params=small)


def wait_told(told: list[DiagnosticArray], level: bytes, words: str) -> dict[str, str]:
    def newest() -> DiagnosticStatus | None:
        status = told[-1].status[0] if told else None
        return status if status and status.level == level and words in status.message else None

    status = wait_until(newest, f"{words!r} on /diagnostics")
    return {item.key: item.value for item in status.values}


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
