"""What Deck adds to a model: from the last byte of its answer to the command on /drive.

`python -m bench.brain.latency` prints a table. The model is a server of the tests that answers at
once; between it and /drive are `ai_brain` and `llm_parser`, as lesson 9 starts them.
"""

from __future__ import annotations

import json
import os
import tempfile
import threading
import time
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING

from ackermann_msgs.msg import AckermannDriveStamped
from std_msgs.msg import ByteMultiArray

from bench.driving import row
from tests.model_server import ModelServer, obeys
from tests.ros.node_process import NodeProcess
from tests.ros.peer import Peer
from tests.waiting import comes, wait_until

if TYPE_CHECKING:
    from tests.model_server import Exchange

ROUNDS = int(os.environ.get("BENCH_ROUNDS", "100"))
GOAL_MS = 15
DOMAIN = 87
ANSWER = json.dumps(
    {
        "thought": "The way is clear.",
        "commands": [{"action": "drive", "speed": 0.2, "steering": 0.1}],
        "say": "I drive on.",
    }
)


class Model:
    """Answers at once, and notes when the last byte of each answer has gone."""

    def __init__(self) -> None:
        self.done_s = 0.0

    def __call__(self, exchange: Exchange) -> None:
        obeys(ANSWER)(exchange)
        self.done_s = time.monotonic()


class Wheels:
    """Notes when a command comes on /drive."""

    def __init__(self, peer: Peer) -> None:
        self.came_s = 0.0
        self.came = threading.Event()
        peer.node.create_subscription(AckermannDriveStamped, "/drive", self._take, 10)

    def _take(self, message: AckermannDriveStamped) -> None:
        if message.drive.speed and not self.came.is_set():
            self.came_s = time.monotonic()
            self.came.set()


def measured(model: Model, wheels: Wheels, peer: Peer) -> list[float]:
    """Return the seconds of each round."""
    voice = ByteMultiArray(data=[bytes((byte,)) for byte in b"go on"])

    def asked() -> bool:
        wheels.came.clear()
        peer.say("/audio/mic_raw", voice)
        return comes(wheels.came.is_set, within_s=2.0)

    wait_until(asked, "the first command")
    taken = []
    for _ in range(ROUNDS):
        begun_s = time.monotonic()
        wait_until(asked, "a command")
        # The server may be held up between its last byte and its look at the clock.
        wait_until(lambda: model.done_s > begun_s, "the end of the answer")  # noqa: B023
        taken.append(max(0.0, wheels.came_s - model.done_s))
    return taken


def main() -> None:
    """Measure, and print the table."""
    model = Model()
    with ExitStack() as stack, tempfile.TemporaryDirectory() as name:
        server = stack.enter_context(ModelServer(model))
        os.environ.update(XDG_CONFIG_HOME=name, XDG_CACHE_HOME=name)
        given = {"base_url": server.url, "model": "m", "budget": {"calls_per_minute": 10_000}}
        folder = Path(name) / "deck"
        folder.mkdir()
        (folder / "llm.yaml").write_text(json.dumps(given))
        for module, params in (("ai_brain", {"backend": "llm"}), ("llm_parser", {})):
            node = NodeProcess(f"nodes.{module}", DOMAIN, params=dict(params))
            stack.callback(node.close)
        peer = stack.enter_context(Peer(DOMAIN))
        taken = measured(model, Wheels(peer), peer)
    print(f"{ROUNDS} answers; load of the machine {os.getloadavg()[0]:.1f}\n")
    print("| | median, ms | 99th percentile, ms | longest, ms | goals, ms |")
    print("| --- | --- | --- | --- | --- |")
    print(row("last byte of the answer to /drive", taken, GOAL_MS))


if __name__ == "__main__":
    main()
