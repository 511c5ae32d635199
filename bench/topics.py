"""Topics open under a hundred Float32 topics at 100 Hz and a picture of 640x480 at 30 Hz: `python -m bench.topics`.

The results are how complete the list is and how true its rates are, the time from an arrow key to its effect, CPU,
memory, and the same CPU while the picture is shown.
"""

from __future__ import annotations

import contextlib
import heapq
import os
import sys
import tempfile
import time
from itertools import cycle
from pathlib import Path
from statistics import median
from typing import TYPE_CHECKING

from bench.processes import cpu_s, deck, of_the_screen, pss_mb, running, table
from bench.screen import key_delays_ms

if TYPE_CHECKING:
    from tests.e2e.terminal import Terminal

DOMAIN = int(os.environ.get("BENCH_DOMAIN", "81"))
NUMBERS = tuple(f"/load/float_{number:02}" for number in range(100))
PICTURE = "/load/picture"
RATES_HZ = {**dict.fromkeys(NUMBERS, 100.0), PICTURE: 30.0}
WARM_UP_S, MEASURE_S = 8.0, 10.0
PRESSES, ROUNDS = 40, 3
SIZE = (120, 230)
"""Half of the rows are the list's."""
PROFILE = "title: {en: Nothing}\nnodes:\n  sleep: {exec: [sleep, infinity]}\n"


def load() -> None:
    """Publish until a signal; delays are made up for, so the mean rates are exact."""
    import rclpy
    from rclpy.serialization import serialize_message
    from sensor_msgs.msg import Image
    from std_msgs.msg import Float32

    def picture(grey: int) -> bytes:
        made = Image(width=640, height=480, encoding="bgr8", step=3 * 640)
        made.data.frombytes(bytes([grey]) * (3 * 640 * 480))
        return serialize_message(made)

    rclpy.init()
    node = rclpy.create_node("load", enable_rosout=False, start_parameter_services=False)
    numbers = [serialize_message(Float32(data=0.01 * n)) for n in range(997)]
    lines = {topic: (node.create_publisher(Float32, topic, 10), cycle(numbers)) for topic in NUMBERS}
    lines[PICTURE] = (node.create_publisher(Image, PICTURE, 10), cycle([picture(n) for n in range(0, 250, 25)]))
    begun_s = time.monotonic()
    due = [(begun_s + 0.0001 * n, topic) for n, topic in enumerate(lines)]
    while rclpy.ok():
        at_s, topic = due[0]
        if (wait_s := at_s - time.monotonic()) > 0:
            time.sleep(wait_s)
            continue
        publisher, messages = lines[topic]
        publisher.publish(next(messages))
        heapq.heapreplace(due, (at_s + 1 / RATES_HZ[topic], topic))


def rates_shown(text: str) -> dict[str, float]:
    """Return the rates in the list; the heading of the selected topic begins with its name, too, and is shorter."""
    rows = (line.replace("▶", " ").split() for line in text.splitlines())
    return {row[0]: float(row[4]) for row in rows if len(row) > 4 and row[4].replace(".", "").isdigit()}


def costs(terminal: Terminal) -> tuple[float, float, float, int]:
    """Return CPU in percent of a core, kB/s to the terminal, the worst error in percent, and the fewest rates."""
    processes = of_the_screen(terminal)
    cpu, sent, begun_s = cpu_s(processes), terminal.received, time.monotonic()
    worst, fewest = 0.0, len(NUMBERS)
    while time.monotonic() - begun_s < MEASURE_S:
        time.sleep(1.0)
        shown = {topic: hz for topic, hz in rates_shown(terminal.text()).items() if topic in NUMBERS}
        fewest = min(fewest, len(shown))
        worst = max([worst, *(100 * abs(hz / RATES_HZ[topic] - 1) for topic, hz in shown.items())])
    passed_s = time.monotonic() - begun_s
    return 100 * (cpu_s(processes) - cpu) / passed_s, (terminal.received - sent) / passed_s / 1000, worst, fewest


def main() -> None:
    """Measure, and print the results."""
    listed, shown, delays, memory = [], [], [], 0.0
    with running("-m", "bench.topics", "load", domain=DOMAIN), tempfile.TemporaryDirectory() as name:
        profile = Path(name, "nothing.yaml")
        profile.write_text(PROFILE)
        for _ in range(ROUNDS):
            with deck(Path(name), str(profile), domain=DOMAIN, size=SIZE) as terminal:
                terminal.wait_for("1/1")
                terminal.press("f3")
                terminal.wait_for(NUMBERS[3])
                time.sleep(WARM_UP_S)
                listed.append(costs(terminal))
                delays += key_delays_ms(terminal, PRESSES)
                terminal.type(f"/{PICTURE}\r")
                terminal.wait_for("640×480")
                shown.append(costs(terminal))
                memory = pss_mb(of_the_screen(terminal))
    print(f"at {SIZE[0]}x{SIZE[1]}; medians of {ROUNDS} turns\n")
    rows = [
        (f"{what}: {figure}", f"{median(turn[column] for turn in turns):.0f} {unit}", "-")
        for what, turns in (("the list", listed), ("the picture shown", shown))
        for column, figure, unit in ((0, "CPU of screen, observer and supervisor", "% of a core"),
                                     (1, "to the terminal", "kB/s"))
    ]  # fmt: skip
    table(
        ("", "", "goal"),
        ("rates in the list, fewest", f"{min(turn[3] for turn in listed)} of {len(NUMBERS)}", "all"),
        ("worst error of a rate", f"{max(turn[2] for turn in listed):.1f} %", "2 %"),
        ("a key is answered, median", f"{median(delays):.0f} ms", "100 ms"),
        (f"the slowest of {len(delays)} keys", f"{max(delays):.0f} ms", "-"),
        *rows,
        ("PSS of the same", f"{memory:.0f} MB", "-"),
    )


if __name__ == "__main__":
    if len(sys.argv) > 1:
        with contextlib.suppress(Exception):  # Its context ends in the middle of a message.
            load()
    else:
        main()
