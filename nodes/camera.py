"""A camera, a video file or a stream, through OpenCV: the newest picture, `rate` times a second.

`source` is the number of a camera (0 is /dev/video0), a /dev path (best one in /dev/v4l/by-id,
which never changes), a video file, or a URL (http, rtsp). A picture of another size is scaled, with
black bars if the shape differs. It reconnects by itself; a file starts again at its end. The state
goes to /diagnostics once a second.
"""

from __future__ import annotations

import os
import sys
import threading
import time
from array import array

import numpy as np
from diagnostic_msgs.msg import DiagnosticStatus
from numpy.typing import NDArray
from sensor_msgs.msg import Image

from nodes.drivers.capture import SILENT_S, THREAD, CameraSource, Capture
from nodes.drivers.diagnostics import Rates, connection_status, tell_every_second
from nodes.parts.node import NEWEST, Choice, LessonNode, Number, Switch, Text, Whole
from nodes.parts.pictures import CHANNELS, fit
from nodes.parts.runner import run
from robot.topics import CAMERA
from text.i18n import N_

_LOOK_EVERY_S = 0.5

_STARTED = N_("The camera publishes {width}x{height} {encoding} from {source}")
_SILENT = N_("{source} is open, but no picture came for {seconds:g} s")
_SINCE = N_("connected to {source} for {seconds:.0f} s")
_NOT_YET = N_("not yet connected to {source}")


class Camera(LessonNode):
    """Publishes from the thread that reads the camera."""

    NAME = "camera"
    source = Text(
        "0", "Camera, video file or stream", fixed=True, or_number=True, form=N_("number, /dev path, file or URL")
    )
    topic = Text(CAMERA, "Where the pictures are published", fixed=True)
    rate = Number(10.0, "Pictures a second, at most", low=0.1, high=120.0, unit="Hz")
    width = Whole(640, "Columns", low=16, high=4096, fixed=True)
    height = Whole(480, "Rows", low=16, high=4096, fixed=True)
    encoding = Choice("bgr8", "Order of colours", choices=("bgr8", "rgb8"), fixed=True)
    frame_id = Text("camera_color_optical_frame", "Frame of the pictures", fixed=True)
    loop = Switch(True, "Whether a file is played again from the start", fixed=True)

    def __init__(self) -> None:
        super().__init__()
        width, height = self.width, self.height
        encoding = self.encoding
        self._message = Image(height=height, width=width, encoding=encoding, step=CHANNELS * width)
        self._message.header.frame_id = self.frame_id
        self._message.data = array("B", bytes(height * width * CHANNELS))
        # The picture is written directly into the message, blue first.
        picture = np.frombuffer(self._message.data, np.uint8).reshape(height, width, CHANNELS)
        self._picture = picture if encoding == "bgr8" else picture[:, :, ::-1]
        self._publisher = self.create_publisher(Image, self.topic, NEWEST)
        self._capture = Capture(
            self.say, CameraSource(self.source), (width, height), lambda: self.rate, self._publish, loop=self.loop
        )
        self._rates = Rates()
        tell_every_second(self, self._status)
        self.every(_LOOK_EVERY_S, self._look)
        source = self._capture.source
        self.say.info(_STARTED, width=width, height=height, encoding=encoding, source=source)
        self._capture.start()

    def before_end(self) -> None:
        self._capture.close()

    # ---------------------------------------------------------------- the capture's thread

    def _publish(self, picture: NDArray[np.uint8]) -> None:
        stamp = self.get_clock().now().to_msg()
        fit(picture, self._picture)
        self._message.header.stamp = stamp
        if self.context.ok():
            self._publisher.publish(self._message)

    # ---------------------------------------------------------------- the node's thread

    def _look(self) -> None:
        if self._capture.silent:
            self.say.warn(_SILENT, every_s=10.0, source=self._capture.source, seconds=SILENT_S)

    def _status(self) -> DiagnosticStatus:
        capture = self._capture
        seconds = time.monotonic() - capture.changed_s
        rates = self._rates.of(capture.came, capture.taken)
        state = DiagnosticStatus.OK, self.say.text(_SINCE, source=capture.source, seconds=seconds)
        if not capture.connected:
            level = DiagnosticStatus.OK if capture.over else DiagnosticStatus.ERROR
            state = level, capture.problem or self.say.text(_NOT_YET, source=capture.source)
        elif capture.silent:
            state = DiagnosticStatus.ERROR, self.say.text(_SILENT, source=capture.source, seconds=SILENT_S)
        return connection_status(
            self.get_name(),
            state,
            str(capture.source),
            capture.since,
            seconds,
            capture.connections,
            frames_in_per_s=f"{rates[0]:.1f}",
            frames_out_per_s=f"{rates[1]:.1f}",
        )


def main() -> int:
    """Run the node until it is asked to end."""
    code = run(Camera)
    if any(thread.name == THREAD for thread in threading.enumerate()):
        # OpenCV is in a read. If it returned while the interpreter shuts down, the process would crash.
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code)
    return code


if __name__ == "__main__":
    raise SystemExit(main())
