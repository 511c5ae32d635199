"""The obvious first solution: one loop that reads the sonar and drives the Pico.

`python -m bench.bare_reflex SONAR PICO`: 50 drive lines per second, and an immediate stop while the
distance is below 0.5 m. No ROS, no reconnection, no other commands.
"""

from __future__ import annotations

import contextlib
import sys
import time
from itertools import count

import serial

from robot.wire.pico import Drive, Hello, encode
from robot.wire.tfluna import Model, TofDecoder

CRITICAL_M, SPEED_RAD_S, PERIOD_S = 0.5, 9.0, 0.02


def main() -> None:
    sonar = serial.Serial(sys.argv[1], 115_200, timeout=PERIOD_S, exclusive=True)
    pico = serial.Serial(sys.argv[2], 115_200, timeout=0, exclusive=True)
    decoder, numbers = TofDecoder(), count(1)
    pico.write(encode(Hello(0)))
    begun_s, due_s, speed = time.monotonic(), 0.0, 0.0
    while True:
        for frame in decoder.feed(sonar.read(9)):
            free = frame.distance_m(Model.LUNA) >= CRITICAL_M
            wanted = SPEED_RAD_S if free and time.monotonic() - begun_s > 1.0 else 0.0
            due_s = 0.0 if wanted < speed else due_s
            speed = wanted
        pico.read(4096)
        if time.monotonic() >= due_s:
            due_s = time.monotonic() + PERIOD_S
            pico.write(encode(Drive(next(numbers) % 65_536, speed, speed, 0.0)))


if __name__ == "__main__":
    with contextlib.suppress(KeyboardInterrupt):
        main()
