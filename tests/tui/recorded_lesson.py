"""Lesson 9 as it was written down: session, nodes, log lines, topics, messages; and the lessons."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from graph.data import GraphUpdate, NodeRow, Sample, ServiceRow, TopicRow, Trouble
from launcher.status import LogLine, NodeState, NodeStatus, SessionInfo, Severity
from text.robot import robot
from tui.session.requests import Lesson, Score, Task

NOW_S = 1_767_225_600.0
"""Unix time of the recording: 2026-01-01 00:00:00 UTC."""

SESSION = SessionInfo(
    run_id="20260101-000000-1",
    profile="profiles/09-brain.yaml",
    name="09-brain",
    title={"en": "One screen instead of five terminals", "ru": "Один экран вместо пяти терминалов"},
    lesson="9",
    domain=42,
    panels=("sonar", "wheels", "camera", "head", "voice"),
    supervisor_pid=4100,
    log_dir="/var/log/deck/20260101-000000-1",
)

_MOCKED = {"sonar_front": "mock_sonar", "camera": "mock_camera", "audio": "mock_audio"}
_OTHERS = ("head_controller", "ai_driver", "safety_stop", "electronic_differential", "ai_brain")
_COMMANDS = _MOCKED | {name: name for name in _OTHERS}

NODES: dict[str, NodeStatus] = {
    name: NodeStatus(
        name=name,
        command=f"nodes.{command}",
        state=NodeState.READY,
        pid=4200 + index,
        uptime_s=83.0 + index / 10,
        restarts=0,
        cpu_percent=0.4 + 0.3 * index,
        memory_bytes=(17 + index) * 1_000_000,
        needs=tuple(_COMMANDS)[:-1] if name == "ai_brain" else (),
        roles=robot().roles.get(f"nodes.{command}", ()),
    )
    for index, (name, command) in enumerate(_COMMANDS.items())
}


def line(
    node: str, seq: int, text: str, severity: Severity = Severity.INFO, at_s: float = 0.0, source: str = "stderr"
) -> LogLine:
    """One line of `node`, `at_s` seconds into the recording."""
    return LogLine(node, seq, NOW_S + at_s, severity, text, logger=node, source=source)


LINES: tuple[LogLine, ...] = (
    line("sonar_front", 1, "Front sonar publishes /sensor/sonar_front once a second", at_s=0.2),
    line("camera", 1, "Camera publishes 640x480 at 10 Hz", at_s=0.4),
    line("ai_brain", 1, "Brain is awake and waits for a voice", at_s=0.9),
    line("sonar_front", 2, "Distance: 1.84 m", at_s=1.2),
    line("safety_stop", 1, "Way is free (1.84 m)", at_s=1.21),
    line("audio", 1, "Человек сказал: «Осмотрись и расскажи, что видишь»", at_s=10.0),
    line("ai_brain", 2, "Услышал голос, думаю над ответом", at_s=10.01),
    line("head_controller", 1, "Поворачиваю голову: pan 45°, tilt 0°", at_s=10.03),
    line("ai_driver", 1, "Команда «вперед»: 0.3 м/с, руль 0.0 рад", at_s=10.04),
    line("electronic_differential", 1, "Left 0.30 m/s, right 0.30 m/s", at_s=10.05),
    line("head_controller", 2, "Голова на месте", at_s=11.04),
    line("safety_stop", 2, "Obstacle at 0.38 m: wheels are held", Severity.WARN, at_s=12.2),
    line("camera", 2, "Frame 120 came 84 ms late", Severity.WARN, at_s=12.4),
    line("ai_driver", 2, "Unknown command: «прыжок»", Severity.ERROR, at_s=14.0),
    line("camera", 3, "exited with code 1, starts again in 1 s", at_s=15.0, source="deck"),
    line("safety_stop", 3, "Way is free (2.31 m)", at_s=16.2),
)

_FLOAT, _STRING = "std_msgs/msg/Float32", "std_msgs/msg/String"
_DRIVE, _JOINTS = "ackermann_msgs/msg/AckermannDriveStamped", "sensor_msgs/msg/JointState"
_BYTES, _IMAGE = "std_msgs/msg/ByteMultiArray", "sensor_msgs/msg/Image"


def topic(name: str, type_name: str, hz: float | None, size: int = 12, **more: Any) -> TopicRow:
    """One healthy topic with one publisher and one subscription."""
    row = TopicRow(
        name,
        (type_name,),
        publishers=1,
        subscribers=1,
        hz=hz,
        bytes_per_s=None if hz is None else hz * size,
        age_s=0.1 if hz is not None else None,
        count=0 if hz is None else int(hz * 80),
        measured=True,
    )
    return replace(row, **more)


TOPICS: tuple[TopicRow, ...] = (
    topic("/ai_command", _STRING, 0.1, age_s=6.0),
    topic("/audio/mic_raw", _BYTES, 0.1, 80, age_s=6.1),
    topic("/audio/speaker_raw", _BYTES, 0.1, 64, age_s=6.0),
    topic("/camera/color/image_raw", _IMAGE, 10.0, 921_664, subscribers=1),
    topic("/drive", _DRIVE, 0.1, 60, age_s=6.0),
    topic("/drive_safe", _DRIVE, 10.0, 60),
    topic("/emergency_stop", "std_msgs/msg/Bool", None, publishers=0, subscribers=2,
          trouble=Trouble.NO_PUBLISHER),
    topic("/head_state", _JOINTS, 10.0, 120),
    topic("/parameter_events", "rcl_interfaces/msg/ParameterEvent", None, publishers=9),
    topic("/rosout", "rcl_interfaces/msg/Log", 2.4, 180, publishers=9),
    topic("/safety_state", "diagnostic_msgs/msg/DiagnosticArray", 1.0, 120),
    topic("/sensor/sonar_front", _FLOAT, 1.0, 8, subscribers=2),
    topic("/wheel_commands", _JOINTS, 10.0, 160),
)  # fmt: skip


def sample(name: str, type_name: str, value: Mapping[str, Any], size: int = 12) -> Sample:
    return Sample(name, type_name, NOW_S, 0.0, size, value)


def header(frame: str = "") -> dict[str, Any]:
    return {"stamp": {"sec": int(NOW_S), "nanosec": 0}, "frame_id": frame}


def joints(name: str, **values: tuple[float, float]) -> Sample:
    positions, velocities = ([pair[at] for pair in values.values()] for at in (0, 1))
    state = {"name": list(values), "position": positions, "velocity": velocities, "effort": []}
    return sample(name, _JOINTS, {"header": header(), **state}, 160)


def lesson_samples() -> dict[str, tuple[Sample, ...]]:
    """The newest message of every topic of lesson 9: turning left at 0.3 m/s, head at 45°."""
    asked = {
        "steering_angle": 0.5, "steering_angle_velocity": 0.0, "speed": 0.3,
        "acceleration": 0.0, "jerk": 0.0,
    }  # fmt: skip
    drive = {"header": header("base_link"), "drive": asked}
    size = {"height": 480, "width": 640, "encoding": "bgr8", "is_bigendian": 0, "step": 1920}
    image = {"header": header("camera_link"), **size, "data": colour_bars()}
    voice = "Осмотрись и расскажи, что видишь".encode()
    answer = "Еду вперёд и осматриваюсь".encode()
    layout: dict[str, Any] = {"dim": [], "data_offset": 0}
    status = {"level": b"\x00", "name": "safety_stop", "message": "", "values": []}
    free = {"header": header(), "status": [status]}
    newest = (
        sample("/sensor/sonar_front", _FLOAT, {"data": 1.84}, 8),
        sample("/ai_command", _STRING, {"data": "налево"}),
        sample("/drive", _DRIVE, drive, 60),
        sample("/drive_safe", _DRIVE, drive, 60),
        joints(
            "/wheel_commands",
            rear_left_wheel_joint=(0.0, 0.2508 / 0.033),
            rear_right_wheel_joint=(0.0, 0.3492 / 0.033),
            steering_joint=(0.5, 0.0),
        ),
        joints("/head_state", pan_joint=(0.7854, 0.0), tilt_joint=(0.1745, 0.0)),
        sample("/audio/mic_raw", _BYTES, {"layout": layout, "data": voice}),
        sample("/audio/speaker_raw", _BYTES, {"layout": layout, "data": answer}),
        sample("/camera/color/image_raw", _IMAGE, image, 921_664),
        sample("/safety_state", "diagnostic_msgs/msg/DiagnosticArray", free),
    )
    return {one.topic: (one,) for one in newest}


def lesson_update(**more: Any) -> GraphUpdate:
    """The graph of lesson 9 with a sample of every topic."""
    add = "example_interfaces/srv/AddTwoInts"
    nodes = tuple(NodeRow(f"/{name}") for name in sorted(NODES))
    services = (ServiceRow("/set_head_position", (add,), ("/head_controller",)),)
    update = GraphUpdate(NOW_S, TOPICS, lesson_samples(), nodes=nodes, services=services)
    return replace(update, **more)


LESSONS = [
    Lesson(
        name="01-hello",
        path=Path("profiles/01-hello.yaml"),
        title={"en": "The first node", "ru": "Первый узел"},
        about={
            "en": "A node is one small program of the robot. This one says hello every second.",
            "ru": "Узел — одна небольшая программа робота. Этот раз в секунду подаёт голос.",
        },
        lesson="1",
        nodes=("hello_node",),
        task=Task(Path("lessons/01-hello"), Score(4, 6, passed=4, earned=6)),
    ),
    Lesson(
        name="02-sonar-safety",
        path=Path("profiles/02-sonar-safety.yaml"),
        title={"en": "Topics: sonar and safety stop", "ru": "Топики: сонар и узел безопасности"},
        lesson="2",
        nodes=("sonar_front", "safety_stop"),
        panels=("sonar",),
        task=Task(
            Path("lessons/02-sonar-safety"),
            Score(5, 10, passed=2, earned=3),
            own=Path("/home/eve/deck-course/02-sonar-safety/lesson.yaml"),
        ),
    ),
    Lesson(
        name="09-brain",
        path=Path("profiles/09-brain.yaml"),
        title=SESSION.title,
        about={
            "en": "The robot hears a phrase, looks around, and drives on or stops.",
            "ru": "Робот слышит фразу, осматривается и едет дальше либо останавливается.",
        },
        lesson="9",
        nodes=tuple(NODES),
        panels=SESSION.panels,
        task=Task(Path("lessons/09-brain"), Score(6, 14)),
    ),
    Lesson(
        name="my-robot",
        path=Path("profiles/my-robot.yaml"),
        title={},
        error="profiles/my-robot.yaml:7:5: nodes.sonar.rum: unknown key (did you mean `run`?)",
    ),
]


_BARS = ((192, 192, 192), (0, 192, 192), (192, 192, 0), (0, 192, 0), (192, 0, 192), (0, 0, 192))


def colour_bars(width: int = 640, height: int = 480) -> bytes:
    """Return a bgr8 picture, row after row: six bars, below them a ramp from black to white."""
    picture = np.zeros((height, width, 3), np.uint8)
    columns = np.arange(width) * len(_BARS) // width
    picture[: height * 3 // 4] = np.array(_BARS, np.uint8)[columns]
    picture[height * 3 // 4 :] = np.linspace(0, 255, width).astype(np.uint8)[:, None]
    return picture.tobytes()
