"""Videos for a camera: files as cameras write them, and a stream over HTTP as cameras serve it."""

from __future__ import annotations

import contextlib
import threading
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import TYPE_CHECKING

import cv2
import numpy as np

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray
    from typing_extensions import Self

WIDTH, HEIGHT = 64, 48
_BOUNDARY = "picture"


def picture(blue: int) -> NDArray[np.uint8]:
    """One colour, (rows, columns, 3)."""
    return np.full((HEIGHT, WIDTH, 3), (blue, 0, 255 - blue), np.uint8)


def write_film(path: Path, pictures: int = 20, fps: float = 50.0) -> None:
    """Motion JPEG, from red to blue."""
    film = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*"MJPG"), fps, (WIDTH, HEIGHT))
    for number in range(pictures):
        film.write(picture(255 * number // (pictures - 1)))
    film.release()


class Stream:
    """Serves Motion JPEG on localhost while it is used in a `with`."""

    def __init__(self, port: int = 0, *, pictures: int | None = None) -> None:
        """After so many pictures it falls silent, with 0 it never answers; port 0 is any."""
        self.asked = threading.Event()
        self._ending = threading.Event()
        self._pictures = pictures
        stream = self

        class Handler(BaseHTTPRequestHandler):
            def do_GET(self) -> None:
                stream.asked.set()
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
        if self._pictures == 0:
            self._ending.wait()
        handler.send_response(200)
        handler.send_header("Content-Type", f"multipart/x-mixed-replace; boundary={_BOUNDARY}")
        handler.end_headers()
        number = 0
        while not self._ending.wait(0.02):
            _made, jpeg = cv2.imencode(".jpg", picture(number % 256))
            head = f"--{_BOUNDARY}\r\nContent-Type: image/jpeg\r\nContent-Length: {len(jpeg)}"
            handler.wfile.write(f"{head}\r\n\r\n".encode() + jpeg.tobytes() + b"\r\n")
            number += 1
            if number == self._pictures:
                self._ending.wait()
