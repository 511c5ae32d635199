"""What anybody may send: every number, text and shape that a message has room for."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from hypothesis import strategies as st

from graph.data import (
    ActionRow,
    EndpointInfo,
    Goal,
    GoalStatus,
    GraphUpdate,
    NodeRow,
    Publication,
    Sample,
    ServiceRow,
    TopicRow,
    Trouble,
)
from launcher.status import LogLine, NodeState, NodeStatus, Severity
from tests.tui.recorded_lesson import NODES, NOW_S

Tree = st.SearchStrategy[Mapping[str, Any]]
doubles = st.one_of(
    st.sampled_from((0.0, -0.0, 0.3, -0.5, 5e-324, 1e-308, 1e9, 1e16, 1e22, 3.4e38, -3.4e38)),
    st.sampled_from((1e308, -1e308, 1.7976931348623157e308)),
    st.sampled_from((float("nan"), float("inf"), float("-inf"))),
    st.floats(),
)
floats = doubles.map(lambda value: float(np.float32(np.clip(value, -3.4e38, 3.4e38))))
int32 = st.sampled_from((0, 1, -1, 7, 2**31 - 1, -(2**31))) | st.integers(-(2**31), 2**31 - 1)
uint32 = st.sampled_from((0, 1, 2, 640, 2**31, 2**32 - 1)) | st.integers(0, 2**32 - 1)
counts = st.sampled_from((0, 1, 3, 255, 10**6, 2**31, 2**63, 2**64 - 1))
texts = st.one_of(
    st.sampled_from(
        ("", " ", "\n\n", "[red]", "[/]", "\x1b]52;c;AAAA\x07", "\u202eabc", "a\u200db")
    ),
    st.sampled_from(
        ("\U000e0041\U000e007f", "\ud800", "й" * 300, "界" * 200, "\t", "{", "{x}", "%s")
    ),
    st.text(max_size=12),
)
maybe = doubles | st.none()


def array(numbers: st.SearchStrategy[float], most: int = 5) -> st.SearchStrategy[Any]:
    return st.lists(numbers, max_size=most).map(np.array)


stamp = st.fixed_dictionaries({"sec": int32, "nanosec": uint32})
header = st.fixed_dictionaries({"stamp": stamp, "frame_id": texts})
point = st.fixed_dictionaries({"x": doubles, "y": doubles, "z": doubles})
turn = st.fixed_dictionaries({"x": doubles, "y": doubles, "z": doubles, "w": doubles})
pose = st.fixed_dictionaries({"position": point, "orientation": turn})
data = st.binary(max_size=64)

JOINTS = ("rear_left_wheel_joint", "rear_right_wheel_joint", "steering_joint")
HEAD = ("pan_joint", "tilt_joint")


def joint_state(*names: str) -> Tree:
    return st.fixed_dictionaries(
        {
            "header": header,
            "name": st.just(list(names)) | st.lists(st.sampled_from(names) | texts, max_size=4),
            "position": array(doubles),
            "velocity": array(doubles),
            "effort": array(doubles),
        }
    )


drive = st.fixed_dictionaries(
    {
        "header": header,
        "drive": st.fixed_dictionaries(
            {
                "steering_angle": floats,
                "steering_angle_velocity": floats,
                "speed": floats,
                "acceleration": floats,
                "jerk": floats,
            }
        ),
    }
)
image = st.fixed_dictionaries(
    {
        "header": header,
        "height": uint32,
        "width": uint32,
        "encoding": st.sampled_from(
            ("bgr8", "rgb8", "mono8", "mono16", "32FC1", "8UC3", "uyvy", "bayer_grbg16")
        )
        | texts,
        "is_bigendian": st.integers(0, 255),
        "step": uint32,
        "data": data,
    }
)
string = st.fixed_dictionaries({"data": texts})
number = st.fixed_dictionaries({"data": floats})
truth = st.fixed_dictionaries({"data": st.booleans()})
voice = st.fixed_dictionaries(
    {
        "layout": st.fixed_dictionaries({"dim": st.just([]), "data_offset": uint32}),
        "data": data | texts.map(lambda text: text.encode("utf-8", "surrogatepass")),
    }
)
twist = st.fixed_dictionaries({"linear": point, "angular": point})
odometry = st.fixed_dictionaries(
    {
        "header": header,
        "child_frame_id": texts,
        "pose": st.fixed_dictionaries({"pose": pose, "covariance": array(doubles, 2)}),
        "twist": st.fixed_dictionaries({"twist": twist, "covariance": array(doubles, 2)}),
    }
)
pose_stamped = st.fixed_dictionaries({"header": header, "pose": pose})
path = st.fixed_dictionaries({"header": header, "poses": st.lists(pose_stamped, max_size=3)})
frame = st.sampled_from(("odom", "base_link", "camera_link", "")) | texts
transform = st.fixed_dictionaries(
    {
        "header": st.fixed_dictionaries({"stamp": stamp, "frame_id": frame}),
        "child_frame_id": frame,
        "transform": st.fixed_dictionaries({"translation": point, "rotation": turn}),
    }
)
transforms = st.fixed_dictionaries({"transforms": st.lists(transform, max_size=5)})
word = st.fixed_dictionaries({"key": texts, "value": texts})
diagnostic = st.fixed_dictionaries(
    {
        "level": st.integers(0, 255),
        "name": st.sampled_from(("safety_stop", "chassis", "nodes: chassis")) | texts,
        "message": texts,
        "hardware_id": texts,
        "values": st.lists(word, max_size=4),
    }
)
diagnostics = st.fixed_dictionaries({"header": header, "status": st.lists(diagnostic, max_size=3)})
room = st.fixed_dictionaries(
    {
        "header": header,
        "info": st.fixed_dictionaries(
            {
                "map_load_time": stamp,
                "resolution": floats,
                "width": st.sampled_from((0, 1, 2, 4, 2**32 - 1)),
                "height": st.sampled_from((0, 1, 2, 4, 2**32 - 1)),
                "origin": pose,
            }
        ),
        "data": st.lists(st.integers(-128, 127), max_size=16).map(
            lambda cells: np.array(cells, np.int8)
        ),
    }
)
log = st.fixed_dictionaries(
    {
        "stamp": stamp,
        "level": st.integers(0, 255),
        "name": texts,
        "msg": texts,
        "file": texts,
        "function": texts,
        "line": uint32,
    }
)

MESSAGES: Mapping[str, tuple[str, Tree]] = {
    "/ai_command": ("std_msgs/msg/String", string),
    "/audio/level": ("std_msgs/msg/Float32", number),
    "/audio/mic_raw": ("std_msgs/msg/ByteMultiArray", voice),
    "/audio/speaker_raw": ("std_msgs/msg/ByteMultiArray", voice),
    "/camera/color/image_raw": ("sensor_msgs/msg/Image", image),
    "/diagnostics": ("diagnostic_msgs/msg/DiagnosticArray", diagnostics),
    "/drive": ("ackermann_msgs/msg/AckermannDriveStamped", drive),
    "/drive_safe": ("ackermann_msgs/msg/AckermannDriveStamped", drive),
    "/emergency_stop": ("std_msgs/msg/Bool", truth),
    "/goal_pose": ("geometry_msgs/msg/PoseStamped", pose_stamped),
    "/head_state": ("sensor_msgs/msg/JointState", joint_state(*HEAD)),
    "/joint_states": ("sensor_msgs/msg/JointState", joint_state(*JOINTS)),
    "/llm_raw_json": ("std_msgs/msg/String", string),
    "/llm_result": ("std_msgs/msg/String", string),
    "/map": ("nav_msgs/msg/OccupancyGrid", room),
    "/mock/pose": ("geometry_msgs/msg/PoseStamped", pose_stamped),
    "/odom": ("nav_msgs/msg/Odometry", odometry),
    "/plan": ("nav_msgs/msg/Path", path),
    "/rosout": ("rcl_interfaces/msg/Log", log),
    "/safety_state": ("diagnostic_msgs/msg/DiagnosticArray", diagnostics),
    "/sensor/sonar_front": ("std_msgs/msg/Float32", number),
    "/sensor/sonar_rear": ("std_msgs/msg/Float32", number),
    "/tf": ("tf2_msgs/msg/TFMessage", transforms),
    "/tf_static": ("tf2_msgs/msg/TFMessage", transforms),
    "/wheel_commands": ("sensor_msgs/msg/JointState", joint_state(*JOINTS)),
}
"""Topic to its type, and to every message that it may carry."""


@st.composite
def samples(draw: Callable[..., Any], topic: str) -> tuple[Sample, ...]:
    """A message or two of a topic, at times of every year."""
    type_name, messages = MESSAGES[topic]
    return tuple(
        Sample(
            topic,
            type_name,
            draw(st.just(NOW_S) | doubles.filter(math.isfinite)),
            draw(doubles),
            draw(counts),
            draw(messages),
            draw(maybe),
        )
        for _each in range(draw(st.integers(1, 2)))
    )


endpoint = st.builds(
    EndpointInfo,
    node=texts,
    type_name=texts,
    reliability=st.sampled_from(("reliable", "best_effort", "")),
    durability=st.sampled_from(("volatile", "transient_local", "")),
    depth=counts,
    history=texts,
    deadline_s=maybe,
    lifespan_s=maybe,
    lease_s=maybe,
)


@st.composite
def topic_row(draw: Callable[..., Any], name: str) -> TopicRow:
    """A topic measured at any rate."""
    type_name = MESSAGES[name][0] if name in MESSAGES else draw(texts)
    return TopicRow(
        name,
        (type_name,),
        publishers=draw(st.sampled_from((0, 1, 1, 1, 10**9))),
        subscribers=draw(counts),
        hz=draw(maybe),
        bytes_per_s=draw(maybe),
        age_s=draw(maybe),
        jitter_s=draw(maybe),
        latency_s=draw(maybe),
        lost=draw(counts | st.none()),
        count=draw(counts),
        measured=draw(st.booleans()),
        trouble=draw(st.none() | st.none() | st.sampled_from(Trouble)),
        detail=draw(texts),
        facts=draw(st.dictionaries(st.sampled_from(("seconds", "type", "more")), texts)),
        published_by=tuple(draw(st.lists(endpoint, max_size=1))),
    )


USUAL = {
    **{topic: TopicRow(topic, (kind,), 1, 1, 10.0) for topic, (kind, _messages) in MESSAGES.items()}
}
"""What nothing is wrong with."""


goal = st.builds(
    Goal,
    number=counts,
    action=st.just("/drive_to_point") | texts,
    type_name=texts,
    status=st.sampled_from(GoalStatus),
    goal=point,
    feedback=st.none() | point,
    feedback_count=counts,
    result=st.none() | point,
    error=texts,
    elapsed_s=doubles,
)
publication = st.builds(
    Publication,
    number=counts,
    topic=st.sampled_from(tuple(MESSAGES)) | texts,
    type_name=texts,
    hz=doubles,
    sent=counts,
    subscribers=counts,
    error=texts,
)
names = st.lists(texts.map(lambda text: f"/{text}"), max_size=3).map(tuple)
node = st.builds(NodeRow, name=texts, publishes=names, subscribes=names, services=names)


@st.composite
def updates(draw: Callable[..., Any]) -> GraphUpdate:
    """A look at a graph in which some say what they like."""
    said = draw(st.lists(st.sampled_from(tuple(MESSAGES)), min_size=1, max_size=5, unique=True))
    odd = draw(st.lists(st.sampled_from(tuple(MESSAGES)) | texts, max_size=2, unique=True))
    rows = {**USUAL, **{name: draw(topic_row(name)) for name in odd}}
    return GraphUpdate(
        time_s=NOW_S,
        topics=tuple(rows[name] for name in sorted(rows)),
        samples={topic: draw(samples(topic)) for topic in said},
        nodes=tuple(draw(st.lists(node, max_size=2))),
        services=tuple(draw(st.lists(st.builds(ServiceRow, texts, names, names), max_size=1))),
        actions=tuple(draw(st.lists(st.builds(ActionRow, texts, names, names), max_size=1))),
        goals=tuple(draw(st.lists(goal, max_size=1))),
        publications=tuple(draw(st.lists(publication, max_size=1))),
    )


@st.composite
def statuses(draw: Callable[..., Any]) -> tuple[NodeStatus, ...]:
    """The lesson's nodes in any state, for any time, with any appetite."""
    odd = draw(st.lists(st.sampled_from(tuple(NODES)), max_size=3, unique=True))
    return tuple(
        replace(
            NODES[name],
            state=draw(st.sampled_from(NodeState)),
            detail=draw(texts),
            pid=draw(counts | st.none()),
            uptime_s=draw(maybe),
            restarts=draw(counts),
            exit_code=draw(st.none() | int32),
            signal=draw(st.none() | texts),
            cpu_percent=draw(maybe),
            memory_bytes=draw(st.none() | counts),
        )
        for name in odd
    )


lines = st.lists(
    st.builds(
        LogLine,
        node=st.sampled_from(tuple(NODES)) | texts,
        seq=counts,
        time_s=doubles,
        severity=st.sampled_from(Severity),
        text=texts,
        logger=texts,
        source=st.sampled_from(("stderr", "stdout", "deck")),
    ),
    max_size=4,
).map(tuple)
