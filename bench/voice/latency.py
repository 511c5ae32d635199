"""The time from the end of a spoken command to /drive: `python -m bench.voice.latency`.

This process is the microphone: it publishes spoken commands in blocks of 100 ms, at the pace of
speech, with a room's faint noise around them. Between it and /drive are the nodes `hearing`
(pocketsphinx), `ai_brain` and `ai_driver`. The end of speech is the last sample louder than the
noise, so the silence that the voice detector waits for is a part of the time; it is also named.
"""

from __future__ import annotations

import os
import statistics
import sys
import threading
import time
from contextlib import ExitStack
from typing import TYPE_CHECKING

import numpy as np
import rclpy
from ackermann_msgs.msg import AckermannDriveStamped
from std_msgs.msg import ByteMultiArray, Float32, String

from bench.driving import environment, running
from brain.speech.espeak import EspeakVoice
from brain.speech.utterances import CLOSING_S
from nodes.parts.sound import to_message
from robot.sound import RATE_HZ
from robot.topics import DRIVE, HEARD, MICROPHONE, SONAR_FRONT

if TYPE_CHECKING:
    from numpy.typing import NDArray

ROUNDS = int(os.environ.get("BENCH_ROUNDS", "24"))
GOAL_S = 0.5
BLOCK_S = 0.1
NOISE, LOUD = 10.0, 300
COMMANDS = ("robot forward", "robot turn left", "robot turn right", "robot go back", "robot stop")
NODES = ("hearing", "ai_brain", "ai_driver")
LONGEST_S = 5.0


class Room:
    """Publishes what is said, and notes when words and a command come."""

    def __init__(self) -> None:
        self.node = rclpy.create_node("room")
        self._microphone = self.node.create_publisher(ByteMultiArray, MICROPHONE, 10)
        self._sonar = self.node.create_publisher(Float32, SONAR_FRONT, 10)
        self.heard_s: list[float] = []
        self.driven_s: list[float] = []
        node = self.node
        node.create_subscription(String, HEARD, lambda _: self.heard_s.append(now()), 10)
        node.create_subscription(AckermannDriveStamped, DRIVE, lambda _: self.driven_s.append(now()), 10)
        self._dice = np.random.default_rng(1)
        self._next_s = now()

    def say(self, wave: NDArray[np.int16]) -> None:
        """Publish samples at their pace."""
        size = int(RATE_HZ * BLOCK_S)
        noisy = wave + self._dice.normal(0.0, NOISE, len(wave))
        for at in range(0, len(wave) - size + 1, size):
            self._next_s += BLOCK_S
            time.sleep(max(0.0, self._next_s - now()))
            block = np.clip(noisy[at : at + size], -32768, 32767).astype("<i2").tobytes()
            self._microphone.publish(to_message(block))
            self._sonar.publish(Float32(data=9.0))

    def trial(self, text: str, voice: str, part_s: float) -> tuple[float, float] | None:
        """Say a command; return seconds to the words and to the command, None if it got lost."""
        said = np.frombuffer(EspeakVoice().speak(text, voice).at(RATE_HZ).pcm, "<i2")
        before = np.zeros(int((1.0 + part_s) * RATE_HZ), np.int16)
        last = int(np.flatnonzero(np.abs(said) > LOUD)[-1])
        ended = len(before) + last
        self._next_s = now()
        end_s = self._next_s + ended / RATE_HZ
        self.heard_s.clear()
        self.driven_s.clear()
        after = np.zeros(int(2.0 * RATE_HZ), np.int16)
        self.say(np.concatenate((before, said[: last + 1], after)))
        until_s = end_s + LONGEST_S
        while now() < until_s and not (self.heard_s and self.driven_s):
            time.sleep(0.01)
        if not (self.heard_s and self.driven_s):
            return None
        return self.heard_s[0] - end_s, self.driven_s[0] - end_s


def now() -> float:
    """Return a time that never jumps, in seconds."""
    return time.monotonic()


def main() -> int:
    os.environ.update(environment())
    voices = ("en-us", "en", "en-us+f2", "en-gb-scotland")
    dice = np.random.default_rng(2)
    with ExitStack() as stack:
        for name in NODES:
            stack.enter_context(running([sys.executable, "-m", f"nodes.{name}"]))
        rclpy.init()
        room = Room()
        threading.Thread(target=rclpy.spin, args=(room.node,), daemon=True).start()
        while room.node.count_subscribers(MICROPHONE) < 2 or not room.node.count_publishers(DRIVE):
            time.sleep(0.1)
        room.trial(COMMANDS[0], voices[0], 0.0)
        # Where in a block the speech ends is left to chance.
        took = [
            room.trial(COMMANDS[at % len(COMMANDS)], voices[at % len(voices)], dice.uniform(0, 0.1))
            for at in range(ROUNDS)
        ]
        rclpy.shutdown()
    came = [each for each in took if each is not None]
    print(f"{ROUNDS} commands in {len(voices)} voices, {ROUNDS - len(came)} not understood;")
    print(f"closing silence of the voice detector {CLOSING_S:g} s, blocks of {BLOCK_S:g} s;")
    print(f"load of the machine {os.getloadavg()[0]:.1f}\n")
    print("| from the end of speech | median, s | longest, s | goal, s |")
    print("| --- | --- | --- | --- |")
    for at, (name, goal) in enumerate((("to the words", ""), ("to /drive", f"{GOAL_S:g}"))):
        times = [each[at] for each in came]
        print(f"| {name} | {statistics.median(times):.2f} | {max(times):.2f} | {goal} |")
    beyond = statistics.median(each[1] for each in came) - CLOSING_S
    print(f"| to /drive, without the closing silence | {beyond:.2f} | | |")
    return 0


if __name__ == "__main__":
    sys.exit(main())
