"""The cost of the Topics screen in a terminal, without ROS: `python -m bench.topics_screen`.

Eleven rows with fluctuating rates arrive at the screen's 4 Hz, and one topic is shown: a number, a
JointState of 40 joints, or a 640x480 picture in which everything moves. The results are the share
of a core and the bytes to the terminal, for the whole program.
"""

from __future__ import annotations

import random
import sys
import threading
import time
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from bench.processes import cpu_s
from graph.data import GraphUpdate
from tests.e2e.terminal import Terminal
from tests.tui.recorded import RecordedGraph, RecordedOpener, sample, topic
from tui.app import DeckApp
from tui.session.requests import OpenRequest
from tui.terminal.driver import DeckDriver
from tui.topics.table.table import TopicsTable

if TYPE_CHECKING:
    from collections.abc import Mapping

    from graph.data import TopicRow

FLOAT, JOINTS = "std_msgs/msg/Float32", "sensor_msgs/msg/JointState"
IMAGE = "sensor_msgs/msg/Image"
PERIOD_S = 0.25
SECONDS = 10.0
SIZES = ((80, 24), (120, 40), (200, 60))
HEADER = {"stamp": {"sec": 0, "nanosec": 0}, "frame_id": ""}


def rows() -> tuple[TopicRow, ...]:
    """Return ten numbers at 50 Hz and a picture at 30 Hz, with slightly varying rates."""
    off = [random.uniform(0.995, 1.005) for _ in range(11)]
    numbers = [topic(f"/load/number_{n}", FLOAT, 50 * off[n], 8, age_s=0.01) for n in range(10)]
    return (topic("/load/image", IMAGE, 30 * off[10], 921_664, age_s=0.02), *numbers)


def message(scene: str, count: int) -> tuple[str, str, Mapping[str, Any]]:
    """Return topic, type and value of the message that is shown."""
    if scene == "number":
        return "/load/number_3", FLOAT, {"data": random.random()}
    if scene == "joints":
        names = [f"joint_{n}" for n in range(40)]
        figures = np.random.default_rng(count).random(40)
        value = {"header": HEADER, "name": names, "position": figures, "velocity": figures}
        return "/load/number_4", JOINTS, value
    noise = np.random.default_rng(count).integers(0, 256, (24, 32, 3), np.uint8)
    data = noise.repeat(20, 0).repeat(20, 1).tobytes()
    size = {"height": 480, "width": 640, "encoding": "rgb8", "step": 1920, "is_bigendian": 0}
    return "/load/image", IMAGE, {"header": HEADER, **size, "data": data}


def child(scene: str) -> None:
    """Run the program, with data from a thread."""
    graph = RecordedGraph(update=None)
    order = OpenRequest(Path("profiles/09-brain.yaml"))
    app = DeckApp(RecordedOpener(graph=graph), order, "topics", driver_class=DeckDriver)

    def feed() -> None:
        for count in range(1_000_000):
            name, type_name, value = message(scene, count)
            table = rows()
            if scene == "joints":
                table = tuple(replace(row, type_names=(JOINTS,)) if row.name == name else row for row in table)
            newest = {name: (sample(name, type_name, value, 8),)} if name in graph.watched else {}
            graph.show(GraphUpdate(time.time(), topics=table, samples=newest))
            # The screen that opens the session has no table yet.
            tables = app.screen.query(TopicsTable)
            if name not in graph.watched and tables:
                app.call_from_thread(tables.first().choose, name)
            time.sleep(PERIOD_S)

    app.call_later(lambda: threading.Thread(target=feed, daemon=True).start())
    app.run()


def main() -> None:
    """Measure every scene at every size and print a table."""
    print("| terminal | shown | CPU of one core | bytes to the terminal |")
    print("| --- | --- | --- | --- |")
    for width, height in SIZES:
        for scene in ("number", "joints", "image"):
            argv = [sys.executable, "-m", "bench.topics_screen", scene]
            terminal = Terminal(argv, width, height, {"COLORTERM": "truecolor"})
            try:
                terminal.wait_for("/load/number_7")
                time.sleep(3)
                pid, begun = terminal.process.pid, time.monotonic()
                cpu, sent = cpu_s([pid]), terminal.received
                time.sleep(SECONDS)
                passed = time.monotonic() - begun
                share = 100 * (cpu_s([pid]) - cpu) / passed
                rate = (terminal.received - sent) / passed / 1000
            finally:
                terminal.close()
            print(f"| {width}x{height} | {scene} | {share:.1f} % | {rate:.1f} kB/s |", flush=True)


if __name__ == "__main__":
    if len(sys.argv) > 1:
        child(sys.argv[1])
    else:
        main()
