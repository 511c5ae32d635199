"""Utterances of lesson 9 as they were written down: messages and log lines of each."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

from graph.data import EndpointInfo, GraphUpdate, Sample, TopicRow
from launcher.status import LogLine
from tests.tui.recorded import NOW_S, joints, lesson_update, line, sample
from tests.tui.recorded_lesson import TOPICS

_STRING, _BYTES = "std_msgs/msg/String", "std_msgs/msg/ByteMultiArray"
_DRIVE = "ackermann_msgs/msg/AckermannDriveStamped"
_PUBLISHERS = {
    "/audio/mic_raw": "/audio",
    "/audio/speaker_raw": "/ai_brain",
    "/ai_command": "/ai_brain",
    "/drive": "/ai_driver",
    "/drive_safe": "/safety_stop",
    "/head_state": "/head_controller",
    "/wheel_commands": "/electronic_differential",
}


def topics() -> tuple[TopicRow, ...]:
    """The topics of lesson 9 with their publishers."""
    return tuple(
        replace(row, published_by=(_end(_PUBLISHERS[row.name], row.type_names[0]),))
        if row.name in _PUBLISHERS
        else row
        for row in TOPICS
    )


def _end(node: str, type_name: str) -> EndpointInfo:
    return EndpointInfo(node, type_name, "reliable", "volatile")


def sound(topic: str, text: str, at_s: float) -> Sample:
    value = {"layout": {"dim": [], "data_offset": 0}, "data": text.encode()}
    return at(sample(topic, _BYTES, value), at_s)


def word(text: str, at_s: float, topic: str = "/ai_command") -> Sample:
    return at(sample(topic, _STRING, {"data": text}), at_s)


def drive(topic: str, speed: float, steering: float, at_s: float) -> Sample:
    value: dict[str, Any] = {"drive": {"speed": speed, "steering_angle": steering}}
    return at(sample(topic, _DRIVE, value), at_s)


def wheels(left: float, right: float, at_s: float) -> Sample:
    return at(
        joints("/wheel_commands", rear_left_wheel_joint=(math.nan, left), rear_right_wheel_joint=(math.nan, right)),
        at_s,
    )


def head(pan_deg: float, at_s: float) -> Sample:
    pan = math.radians(pan_deg)
    return at(joints("/head_state", pan_joint=(pan, 0.0), tilt_joint=(0.0, 0.0)), at_s)


def at(one: Sample, at_s: float) -> Sample:
    """A message that arrived so long after the beginning, and was taken 40 ms later."""
    return replace(one, received_s=NOW_S + at_s + 0.04, age_s=0.04)


def update(*samples: Sample) -> GraphUpdate:
    grouped: dict[str, tuple[Sample, ...]] = {}
    for one in samples:
        grouped[one.topic] = (*grouped.get(one.topic, ()), one)
    return lesson_update(topics=topics(), samples=grouped)


BEFORE = (drive("/drive_safe", 0.0, 0.0, -1.0), wheels(0.0, 0.0, -1.0), head(0.0, -1.0))
"""What the repeating topics say while nothing happens."""
PHRASE = "VOICE_COMMAND: осмотрись и расскажи, что там"


def voice(t: float) -> tuple[Sample, ...]:
    """Somebody speaks: the brain turns the head, drives, answers."""
    return (
        sound("/audio/mic_raw", PHRASE, t),
        word("вперед", t + 0.0042),
        sound("/audio/speaker_raw", "Осматриваюсь и еду вперёд.", t + 0.0046),
        drive("/drive", 0.5, 0.0, t + 0.0061),
        drive("/drive_safe", 0.5, 0.0, t + 0.0079),
        drive("/drive_safe", 0.5, 0.0, t + 0.2079),
        wheels(15.38, 15.38, t + 0.0098),
        wheels(15.38, 15.38, t + 0.5098),
        head(2.0, t + 0.055),
        head(24.0, t + 0.53),
        head(45.0, t + 1.012),
        head(45.0, t + 1.512),
    )


def voice_lines(t: float, seq: int = 1) -> tuple[LogLine, ...]:
    return (
        line("ai_brain", seq, "Слышу: «осмотрись и расскажи, что там»", at_s=t + 0.0012),
        line("ai_brain", seq + 1, "Думаю: голос, кадр и 2.40 м впереди", at_s=t + 0.0021),
        line("ai_brain", seq + 2, "Решение: Путь свободен: осмотрюсь, поеду", at_s=t + 0.003),
        line("head_controller", seq, "Поворачиваю голову: pan 45°, tilt 0°", at_s=t + 0.0053),
        line("ai_driver", seq, "Команда «вперед»: 0.50 м/с, руль 0.00 рад", at_s=t + 0.006),
        line("head_controller", seq + 1, "Голова на месте: pan 45°, tilt 0°", at_s=t + 1.0101),
        line("sonar_front", seq, "Расстояние: 2.35 м", at_s=t + 1.3),
    )


def command(t: float) -> tuple[Sample, ...]:
    return (
        word("налево", t),
        drive("/drive", 0.3, 0.5, t + 0.0021),
        drive("/drive_safe", 0.3, 0.5, t + 0.0038),
        wheels(7.72, 10.74, t + 0.0052),
    )
