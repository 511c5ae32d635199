"""Drivers as they were written down: what they say on /diagnostics, and frames of their ports."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

from graph.data import GraphUpdate, Sample
from launcher.status import NodeState, NodeStatus
from robot.frames.protocols import Chunk, FrameBatcher, FrameLine, encode
from robot.frames.readers import PicoReader
from robot.wire import pico as wire_pico
from robot.wire.pico import Drive, Telemetry
from tests.tui.recorded import NOW_S, RecordedGraph, RecordedOpener, RecordedSession
from tests.tui.recorded_lesson import TOPICS, lesson_update, sample, topic

AT_S = NOW_S + 17.0
"""The moment at which the clock of the tests stands."""
_ARRAY, _STRING = "diagnostic_msgs/msg/DiagnosticArray", "std_msgs/msg/String"
_FOLDER = "/run/user/1000/deck/devices/42"
PORTS = {"chassis": "pico", "sonar_front": "tof_front", "sonar_rear": "tof_rear"}


def status(name: str, level: int = 0, message: str = "", **values: object) -> Sample:
    told = {
        "port": f"{_FOLDER}/{PORTS.get(name, name)}",
        "connected": "true",
        "connected_since": "2026-01-01T00:00:02+00:00",
        "seconds": "15.0",
        "connections": "1",
        "reconnects": "0",
        "bytes_in_per_s": "900",
        "bytes_out_per_s": "0",
        "frames_in_per_s": "100.0",
        "errors_per_s": "0.0",
        "errors": "0",
        **{key: str(value) for key, value in values.items()},
    }
    return _array(name, level, message, told)


def _array(name: str, level: int, message: str, values: dict[str, str]) -> Sample:
    value: dict[str, Any] = {
        "header": {"stamp": {"sec": int(AT_S), "nanosec": 0}, "frame_id": ""},
        "status": [
            {
                "level": level,
                "name": name,
                "message": message,
                "hardware_id": values.get("port", ""),
                "values": [{"key": key, "value": one} for key, one in values.items()],
            }
        ],
    }
    return replace(sample("/diagnostics", _ARRAY, value), received_s=AT_S)


def foreign(name: str = "imu: data", message: str = "calibrated") -> Sample:
    """A driver of another make, which has none of our figures."""
    return _array(name, 0, message, {"Temperature": "31"})


STATUSES = (
    status(
        "chassis",
        1,
        "The wheels stand: no drive line for 250 ms",
        bytes_in_per_s=3150,
        bytes_out_per_s=1290,
        frames_in_per_s="50.0",
        errors=3,
    ),
    status("sonar_front", 0, f"connected to {_FOLDER}/tof_front for 15 s"),
    status(
        "sonar_rear",
        2,
        f"Cannot open {_FOLDER}/tof_rear: no such port; plug it in, or set the parameter port",
        connected="false",
        connected_since="",
        seconds="4.0",
        bytes_in_per_s=0,
        frames_in_per_s="0.0",
        errors=12,
        errors_per_s="0.0",
        reconnects=1,
    ),
    foreign(),
)


def frames(name: str, lines: Iterable[FrameLine]) -> Sample:
    return sample(f"/{name}/frames", _STRING, {"data": encode(list(lines))})


def of_chassis(count: int = 8, language: str = "en") -> Sample:
    """Drive lines out, telemetry in, and what noise makes of them."""
    chunks: list[Chunk] = []
    for at in range(count):
        drive = wire_pico.encode(Drive((at + 17) % 65536, 3.2, 3.4, 0.1))
        told = Telemetry(at, 61_000 + 20 * at, at + 16, 3.1, 3.3, 0.1, 7.42, 0.81, 0.79, 0)
        chunks.append(Chunk(AT_S - 1 + at / 50, "out", drive))
        line = wire_pico.encode(told)
        if at == 4:
            line = b"\xff\x00" + line.replace(b"3300", b"3301")
        chunks.append(Chunk(AT_S - 0.99 + at / 50, "in", line))
    return frames("chassis", FrameBatcher(PicoReader, language).tell(chunks, AT_S))


def update(*samples: Sample, publishers: tuple[str, ...] = tuple(PORTS)) -> GraphUpdate:
    """The graph with the drivers' topics, and these messages."""
    topics = [topic(f"/{name}/frames", _STRING, None, subscribers=0) for name in publishers]
    if publishers:
        topics.append(topic("/diagnostics", _ARRAY, 4.0))
    together: dict[str, tuple[Sample, ...]] = {}
    for one in samples:
        together[one.topic] = (*together.get(one.topic, ()), one)
    rows = tuple(sorted((*TOPICS, *topics), key=lambda row: row.name))
    return lesson_update(time_s=AT_S, topics=rows, samples=together)


def with_drivers(*samples: Sample) -> RecordedOpener:
    session = RecordedSession(nodes=_nodes(), lines=())
    return RecordedOpener(session, RecordedGraph(update(*(samples or STATUSES))))


def _nodes() -> dict[str, NodeStatus]:
    commands = {"chassis": "nodes.chassis", "sonar_front": "nodes.tof_sonar"}
    return {
        name: NodeStatus(name, command, NodeState.READY, pid=4200, roles=("driver",))
        for name, command in commands.items()
    }
