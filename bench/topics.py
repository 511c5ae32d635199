"""Topics open under a hundred Float32 topics at 100 Hz and a picture of 640x480 at 30 Hz: `python -m bench.topics`.

The results are how complete the list is and how true its rates are, the time from an arrow key to its effect, CPU,
memory, and the same CPU while the picture is shown.
"""

from __future__ import annotations

import heapq
import os
import statistics
import subprocess
import sys
import tempfile
import time
from contextlib import contextmanager
from itertools import cycle
from pathlib import Path
from typing import TYPE_CHECKING

from bench.processes import cpu_s, pss_mb, stdin_closed
from bench.screen import key_delays_ms, screen_processes
from tests.e2e.terminal import Terminal, own_folders

if TYPE_CHECKING:
    from collections.abc import Iterator

DOMAIN = os.environ.get("BENCH_DOMAIN", "81")
NUMBERS = tuple(f"/load/float_{number:02}" for number in range(100))
PICTURE = "/load/picture"
RATES_HZ = {**dict.fromkeys(NUMBERS, 100.0), PICTURE: 30.0}
WARM_UP_S = 8.0
MEASURE_S = 10.0
PRESSES = 40
ROUNDS = 3
COLUMNS, ROWS = 120, 230
"""Half of the rows are the list's."""


def load() -> None:
    """Publish until stdin is closed; delays are made up for, so the mean rates are exact."""
    from rclpy.context import Context
    from rclpy.node import Node
    from rclpy.serialization import serialize_message
    from sensor_msgs.msg import Image
    from std_msgs.msg import Float32

    def picture(grey: int) -> Image:
        made = Image(width=640, height=480, encoding="bgr8", step=3 * 640)
        made.data.frombytes(bytes([grey]) * (3 * 640 * 480))
        return made

    context = Context()
    context.init(args=[], domain_id=int(DOMAIN))
    node = Node("load", context=context, enable_rosout=False, start_parameter_services=False)
    numbers = [serialize_message(Float32(data=0.01 * n)) for n in range(997)]
    pictures = [serialize_message(picture(grey)) for grey in range(0, 250, 25)]
    lines = {topic: (node.create_publisher(Float32, topic, 10), cycle(numbers)) for topic in NUMBERS}
    lines[PICTURE] = (node.create_publisher(Image, PICTURE, 10), cycle(pictures))
    ended = stdin_closed()
    print("ready", flush=True)
    begun_s = time.monotonic()
    due = [(begun_s + 0.0001 * n, topic) for n, topic in enumerate(lines)]
    while not ended.is_set():
        at_s, topic = due[0]
        if (wait_s := at_s - time.monotonic()) > 0:
            time.sleep(wait_s)
            continue
        publisher, messages = lines[topic]
        publisher.publish(next(messages))
        heapq.heapreplace(due, (at_s + 1 / RATES_HZ[topic], topic))
    node.destroy_node()
    context.try_shutdown()


@contextmanager
def loaded() -> Iterator[None]:
    """Run the load in a process of its own."""
    env = {**os.environ, "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
    argv = [sys.executable, "-m", "bench.topics", "load"]
    process = subprocess.Popen(argv, env=env, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    try:
        assert process.stdout is not None
        process.stdout.readline()
        yield
    finally:
        process.communicate(timeout=30)


@contextmanager
def topics_open(folder: Path) -> Iterator[Terminal]:
    """Run the program in a terminal tall enough for all topics, with the Topics screen open."""
    profile = folder / "nothing.yaml"
    profile.write_text("title: {en: Nothing}\nnodes:\n  sleep: {exec: [sleep, infinity]}\n")
    argv = [sys.executable, "-m", "tui", str(profile), "--domain", DOMAIN, "--lang", "en"]
    # Over SSH, pictures would be limited.
    terminal = Terminal(argv, COLUMNS, ROWS, own_folders(folder, SSH_CONNECTION=""))
    try:
        terminal.wait_for("1/1")
        terminal.press("f3")
        terminal.wait_for(NUMBERS[3])
        time.sleep(WARM_UP_S)
        yield terminal
    finally:
        terminal.close()


def rates_shown(text: str) -> dict[str, float]:
    """Return the rates in the list; the heading of the selected topic begins with its name, too, and is shorter."""
    rows = (line.replace("▶", " ").split() for line in text.splitlines())
    return {row[0]: float(row[4]) for row in rows if len(row) > 4 and row[4].replace(".", "").isdigit()}


def costs(terminal: Terminal) -> tuple[float, float, float, int]:
    """Return CPU in percent of a core, kB/s to the terminal, the worst error in percent, and the fewest rates."""
    pids = screen_processes(terminal)
    cpu, sent, begun_s = cpu_s(pids), terminal.received, time.monotonic()
    worst, fewest = 0.0, len(NUMBERS)
    while time.monotonic() - begun_s < MEASURE_S:
        time.sleep(1.0)
        shown = {topic: hz for topic, hz in rates_shown(terminal.text()).items() if topic in NUMBERS}
        fewest = min(fewest, len(shown))
        worst = max([worst, *(100 * abs(hz / RATES_HZ[topic] - 1) for topic, hz in shown.items())])
    passed_s = time.monotonic() - begun_s
    return 100 * (cpu_s(pids) - cpu) / passed_s, (terminal.received - sent) / passed_s / 1000, worst, fewest


def main() -> None:
    """Measure, and print the results."""
    listed, shown, delays, memory = [], [], [], 0.0
    with loaded(), tempfile.TemporaryDirectory() as name:
        for _ in range(ROUNDS):
            with topics_open(Path(name)) as terminal:
                listed.append(costs(terminal))
                delays += key_delays_ms(terminal, PRESSES)
                terminal.press("/")
                terminal.type(f"{PICTURE}\r")
                terminal.wait_for("640×480")
                shown.append(costs(terminal))
                memory = pss_mb(screen_processes(terminal))
    print(f"at {COLUMNS}x{ROWS}; medians of {ROUNDS} turns\n")
    print("| | | goal |")
    print("| --- | --- | --- |")
    print(f"| rates in the list, fewest | {min(turn[3] for turn in listed)} of {len(NUMBERS)} | all |")
    print(f"| worst error of a rate | {max(turn[2] for turn in listed):.1f} % | 2 % |")
    print(f"| a key is answered, median | {statistics.median(delays):.0f} ms | 100 ms |")
    print(f"| the slowest of {len(delays)} keys | {max(delays):.0f} ms | - |")
    for what, turns in (("the list", listed), ("the picture shown", shown)):
        cpu, sent = (statistics.median(turn[column] for turn in turns) for column in (0, 1))
        print(f"| {what}: CPU of screen, observer and supervisor | {cpu:.0f} % of a core | - |")
        print(f"| {what}: to the terminal | {sent:.0f} kB/s | - |")
    print(f"| PSS of the same | {memory:.0f} MB | - |")


if __name__ == "__main__":
    if len(sys.argv) > 1:
        load()
    else:
        main()
