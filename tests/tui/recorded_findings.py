"""The graph of lesson 9 with what can go wrong in one, as it was seen."""

from __future__ import annotations

from dataclasses import replace

from graph.data import EndpointInfo, GraphUpdate, NodeRow
from tests.tui.recorded_lesson import topic
from tests.tui.recorded_nodes import NODE_ROWS, graph_update

FLOAT, IMAGE = "std_msgs/msg/Float32", "sensor_msgs/msg/Image"


def _end(node: str, kind: str, reliability: str = "reliable") -> EndpointInfo:
    return EndpointInfo(node, kind, reliability, "volatile")


def ill_graph() -> GraphUpdate:
    """Return a name with a letter missing, QoS that does not fit, a lost service, a slow clock."""
    healthy = graph_update()
    image = "/camera/color/image_raw"
    ill = (
        topic(
            "/sensor/sonar_frnt", FLOAT, None, publishers=0, subscribers=1,
            subscribed_by=(_end("/guard", FLOAT),),
        ),
        topic(
            "/sensor/sonar_front", FLOAT, 1.0, 8, subscribers=2,
            published_by=(_end("/sonar_front", FLOAT),),
        ),
        topic(
            image, IMAGE, 10.0, 921_664, subscribers=1,
            published_by=(_end("/camera", IMAGE, "best_effort"),),
            subscribed_by=(_end("/ai_brain", IMAGE),),
        ),
        topic(
            "/imu", "sensor_msgs/msg/Imu", 50.0, 320, subscribers=0,
            published_by=(_end("/imu_board", "sensor_msgs/msg/Imu"),), latency_s=-2.5,
        ),
    )  # fmt: skip
    names = {row.name for row in ill}
    rows = (*(row for row in healthy.topics if row.name not in names), *ill)
    guard = NodeRow("/guard", subscribes=("/sensor/sonar_frnt",), clients=("/set_head_postion",))
    return replace(
        healthy,
        topics=tuple(sorted(rows, key=lambda row: row.name)),
        nodes=tuple(sorted((*NODE_ROWS, guard), key=lambda row: row.name)),
    )
