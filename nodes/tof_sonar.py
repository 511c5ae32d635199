"""A ToF sonar on a serial port: Benewake TF-Luna, TFmini-S or TFmini Plus.

Publishes metres as Float32 on `topic` and as Range on `topic`/range, by REP-117: +inf nothing in
range, -inf too close to measure, nan no valid reading. While the port is missing or silent it
publishes nan ten times a second, so that nobody relies on an old distance. It reconnects by itself.
Its state goes to /diagnostics once a second, its frames in words to `~/frames`.
"""

from __future__ import annotations

import math
import time
from functools import partial

from diagnostic_msgs.msg import DiagnosticStatus
from sensor_msgs.msg import Range
from std_msgs.msg import Float32

from nodes.drivers.diagnostics import tell_every_second
from nodes.drivers.serial_link import SerialLink
from nodes.parts.node import DEPTH, Choice, LessonNode, Number, PeriodicThread, Text, Whole
from nodes.parts.runner import run
from robot.frames.readers import TofReader
from robot.topics import SONAR_FRONT
from robot.wire.tfluna import BAUD, Model, TofDecoder
from text.i18n import N_

_LOOK_EVERY_S = 0.1

_STARTED = N_("The sonar at {port} publishes {topic}")
_SILENT = N_("No distance from {port} for {seconds:g} s: is it a {model}, and is it wired?")
_GARBLED = N_("Bytes from {port} make no sense: wrong port, wrong baud, or a bad cable?")


class TofSonar(LessonNode):
    """Reads frames on its own thread and publishes them from there."""

    NAME = "tof_sonar_front"
    port = Text("/dev/ttyUSB0", "Device path; best one in /dev/serial/by-id", fixed=True)
    baud = Whole(BAUD, "Speed of the port", fixed=True, low=9600, high=921_600)
    model = Choice(Model.LUNA.value, "Which sensor it is", fixed=True, choices=tuple(model.value for model in Model))
    topic = Text(SONAR_FRONT, "Where the distance is published", fixed=True)
    frame_id = Text("sonar_front_link", "Frame of the readings", fixed=True)
    every_ = Whole(2, "Every n-th reading is published", low=1, high=1000)
    silent_after_s = Number(
        0.5, "The sensor counts as silent after this long without a reading", low=0.1, high=10.0, unit="s"
    )

    def __init__(self) -> None:
        super().__init__()
        self._model = Model(self.model)
        self._decoder = TofDecoder()
        self._skipped = 0
        self._seen_s = time.monotonic()
        topic = self.topic
        self._distances = self.create_publisher(Float32, topic, DEPTH)
        self._ranges = self.create_publisher(Range, f"{topic}/range", DEPTH)
        self._link = SerialLink(
            self, self.baud, self._hear, self._begin, self._publish_nothing, partial(TofReader, model=self._model)
        )
        tell_every_second(self, self._status)
        self._pace = PeriodicThread(_LOOK_EVERY_S, self._look)
        self.say.info(_STARTED, port=self._link.port, topic=topic)
        self._link.start()
        self._pace.start()

    def before_end(self) -> None:
        self._pace.close()
        self._link.close()

    # ---------------------------------------------------------------- the reader's thread

    def _begin(self) -> None:
        self._seen_s = time.monotonic()

    def _hear(self, data: bytes) -> None:
        for frame in self._decoder.feed(data):
            self._seen_s = time.monotonic()
            self._skipped += 1
            if self._skipped >= self.every_:
                self._skipped = 0
                self._publish(frame.distance_m(self._model))

    def _publish_nothing(self) -> None:
        self._publish(math.nan)

    def _publish(self, metres: float) -> None:
        if not self.context.ok():
            return
        self._distances.publish(Float32(data=metres))
        if not self._ranges.get_subscription_count():
            return
        message = Range(
            radiation_type=Range.INFRARED,
            field_of_view=self._model.view_rad,
            min_range=self._model.range_m[0],
            max_range=self._model.range_m[1],
            range=metres,
        )
        message.header.stamp = self.get_clock().now().to_msg()
        message.header.frame_id = self.frame_id
        self._ranges.publish(message)

    # ---------------------------------------------------------------- at a pace

    @property
    def _silent(self) -> bool:
        return time.monotonic() - self._seen_s > self.silent_after_s

    def _look(self) -> None:
        if not self._silent:
            return
        self._publish_nothing()
        if not self._link.connected:
            return
        if self._decoder.skipped > self._decoder.frames + 100:
            self.say.warn(_GARBLED, every_s=10.0, port=self._link.port)
        else:
            self.say.warn(_SILENT, every_s=10.0, **self._who())

    def _who(self) -> dict[str, object]:
        return {"port": self._link.port, "seconds": self.silent_after_s, "model": self._model.value}

    def _status(self) -> DiagnosticStatus:
        status = self._link.status(self.get_name(), self._decoder.errors, self._decoder.frames)
        if self._link.connected and self._silent:
            status.level = status.ERROR
            status.message = self.say.text(_SILENT, **self._who())
        return status


if __name__ == "__main__":
    raise SystemExit(run(TofSonar))
