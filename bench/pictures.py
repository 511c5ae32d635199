"""A 1280x720 camera at 30 Hz on the Topics screen, in a real terminal: `python -m bench.pictures`.

The goal is ten pictures per second at no more than 40 % of one core. Every picture carries its
number as five black or white squares along its top edge; a picture counts when the number on the
terminal changes. The rest is a still room with camera noise and one moving object.
"""

from __future__ import annotations

import os
import statistics
import sys
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from bench.observer import program
from bench.processes import cpu_s, watch_stdin
from bench.screen import screen_processes
from tests.e2e.terminal import Terminal, own_folders

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

DOMAIN = os.environ.get("BENCH_DOMAIN", "78")
WIDTH, HEIGHT, RATE_HZ = 1280, 720, 30.0
BITS = 5
SQUARE = WIDTH // BITS
TOPIC = "/bench/camera"
COLUMNS, ROWS = 120, 40
WARM_UP_S = 6.0
MEASURE_S = 10.0
ROUNDS = 3


def camera(domain: str) -> None:
    """Act as the camera: publish numbered pictures until stdin is closed."""
    from rclpy.context import Context
    from rclpy.node import Node
    from rclpy.serialization import serialize_message
    from sensor_msgs.msg import Image

    messages = []
    for picture in pictures():
        message = Image(height=HEIGHT, width=WIDTH, encoding="bgr8", step=3 * WIDTH)
        message.data.frombytes(picture.tobytes())
        messages.append(serialize_message(message))
    context = Context()
    context.init(args=[], domain_id=int(domain))
    node = Node("camera", context=context, enable_rosout=False, start_parameter_services=False)
    publisher = node.create_publisher(Image, TOPIC, 10)
    ended = watch_stdin()
    print("ready", flush=True)
    started, number = time.monotonic(), 0
    while not ended.wait(max(0.0, started + number / RATE_HZ - time.monotonic())):
        publisher.publish(messages[number % len(messages)])
        number += 1
    node.destroy_node()
    context.try_shutdown()


def pictures() -> Iterator[NDArray[np.uint8]]:
    """Yield the numbered pictures, each with its own noise."""
    random = np.random.default_rng(1)
    across, down = np.linspace(0, 160, WIDTH), np.linspace(20, 70, HEIGHT)
    room = (across[None, :, None] + down[:, None, None] + (0, 5, 10)).astype(np.uint8)
    for number in range(1 << BITS):
        picture = room + random.integers(0, 6, room.shape, np.uint8)
        for bit in range(BITS):
            shade = 255 * (number >> bit & 1)
            picture[: HEIGHT // 8, bit * SQUARE : (bit + 1) * SQUARE] = shade
        left = number * (WIDTH - 200) >> BITS
        picture[300:500, left : left + 200] = (40, 160, 240)
        yield picture


def picture_row(terminal: Terminal) -> tuple[int, int, int] | None:
    """Return the first row of the picture below the heading, its first column and its width."""
    lines = terminal.text().splitlines()
    head = next((y for y, line in enumerate(lines) if line.startswith(TOPIC)), None)
    if head is None:
        return None
    for top in range(head + 1, ROWS - 2):
        grounds = [terminal.ground(x, top + 1) for x in range(COLUMNS)]
        outside = grounds[0]
        inside = [x for x, ground in enumerate(grounds) if ground != outside]
        if len(inside) > COLUMNS // 3:
            return top + 1, inside[0], inside[-1] - inside[0] + 1
    return None


def turn(terminal: Terminal) -> tuple[float, float, float]:
    """Return pictures per second, CPU of screen and supervisor in percent of a core, and kB/s."""
    pids = screen_processes(terminal)
    cpu, sent, begun = cpu_s(pids), terminal.received, time.monotonic()
    place = picture_row(terminal)
    if place is None:
        raise RuntimeError(f"no picture:\n{terminal.text()}")
    top, left, width = place
    places = [left + (2 * bit + 1) * width // (2 * BITS) for bit in range(BITS)]
    shown, before = 0, None
    while time.monotonic() - begun < MEASURE_S:
        now = tuple(terminal.ground(x, top) > "7" for x in places)
        shown += now != before
        before = now
        time.sleep(0.015)
    passed = time.monotonic() - begun
    return (shown / passed, 100 * (cpu_s(pids) - cpu) / passed, (terminal.received - sent) / passed / 1000)


def main() -> None:
    """Measure several turns and print the results."""
    turns = []
    with program("bench.pictures", DOMAIN), tempfile.TemporaryDirectory() as name:
        for _round in range(ROUNDS):
            terminal = open_topic(Path(name))
            try:
                time.sleep(WARM_UP_S)
                turns.append(turn(terminal))
            finally:
                terminal.close()
    pictures, cpu, rate = (statistics.median(figures) for figures in zip(*turns, strict=True))
    print(f"{WIDTH}x{HEIGHT} bgr8 at {RATE_HZ:g} Hz at {COLUMNS}x{ROWS}; medians of {ROUNDS} turns")
    print("| what | measured | goal |")
    print("| --- | --- | --- |")
    print(f"| pictures shown a second | {pictures:.1f} | 10 |")
    print(f"| screen and supervisor, CPU of one core | {cpu:.1f} % | 40 % |")
    print(f"| to the terminal | {rate:.0f} kB/s | - |")


def open_topic(folder: Path) -> Terminal:
    """Return the program, with the camera's topic selected."""
    profile = folder / "nothing.yaml"
    profile.write_text("title: {en: Nothing}\nnodes:\n  sleep: {exec: [sleep, infinity]}\n")
    # Otherwise the limit over SSH would apply to pictures.
    env = own_folders(folder, SSH_CONNECTION="")
    argv = [sys.executable, "-m", "tui", str(profile), "--domain", DOMAIN, "--lang", "en"]
    terminal = Terminal(argv, COLUMNS, ROWS, env)
    terminal.wait_for("1/1")
    terminal.press("f3")
    terminal.wait_for(f"▶ {TOPIC}")
    return terminal


if __name__ == "__main__":
    if len(sys.argv) > 1:
        camera(sys.argv[1])
    else:
        main()
