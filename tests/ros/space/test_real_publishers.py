"""The layers of the Space screen, fed by real publishers through the observer."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import OccupancyGrid, Odometry, Path
from sensor_msgs.msg import LaserScan, PointCloud2, Range
from std_msgs.msg import Float32, String

from graph.messages.types import load_message
from space.drawing.camera import SpaceCamera
from space.drawing.paints import Tint
from tests.ros.observing import Watcher
from tests.ros.peer import LATCHED, Peer
from tests.ros.space.test_real_messages import cloud, pose
from tests.waiting import wait_until
from tui.space.stage import Stage

MARKER = "visualization_msgs/msg/Marker"
TOO_SHORT = "500000 points of 12 bytes are announced, and 12000 bytes have come"


def in_frame(message: Any) -> Any:
    """Give a message the frame of all others."""
    message.header.frame_id = "odom"
    return message


def messages() -> dict[str, Any]:
    """One message of each type, by topic; one cloud is much too short."""
    grid = OccupancyGrid(data=[0, 100, -1, 100])
    grid.info.width = grid.info.height = 2
    grid.info.resolution = 1.0
    driven = Odometry()
    driven.pose.pose = pose(1.0, 2.0)
    short = cloud()
    short.width = 500_000
    marker = load_message(MARKER)(type=1, ns="a")
    marker.scale.x = marker.scale.y = marker.scale.z = 0.5
    marker.pose = pose(3.0, 0.0)
    path = Path(poses=[PoseStamped(pose=pose(0.0, 0.0)), PoseStamped(pose=pose(1.0, 0.0))])
    return {
        "/map": in_frame(grid),
        "/scan": in_frame(LaserScan(angle_increment=0.1, range_max=9.0, ranges=[1.0, 2.0])),
        "/range": in_frame(Range(field_of_view=0.3, max_range=4.0, range=1.0)),
        "/cloud": in_frame(cloud()),
        "/short_cloud": in_frame(short),
        "/plan": in_frame(path),
        "/goal_pose": in_frame(PoseStamped(pose=pose(1.0, 1.0))),
        "/odom": in_frame(driven),
        "/marker": in_frame(marker),
        "/sensor/sonar_front": Float32(data=1.0),
        "/robot_description": String(data="<robot name='r'><link name='odom'/></robot>"),
    }


def seen(watcher: Watcher, stage: Stage) -> Stage:
    """Let a stage see everything that has come, and ask for what it needs."""
    samples = {topic: tuple(found) for topic, found in watcher.samples.items()}
    stage.take(replace(watcher.update, samples=samples), 0.0)
    watcher.observer.watch(stage.layers.watched())
    watcher.observer.follow(stage.layers.followed())
    stage.place(SpaceCamera(), 0.0)
    return stage


def until_heard(watcher: Watcher, stage: Stage, topics: set[str]) -> None:
    """Wait until each of these topics has a layer that has heard something."""

    def heard() -> bool:
        layers = seen(watcher, stage).layers
        return topics <= {layer.topic for layer in layers if layer.heard}

    wait_until(heard, lambda: f"{topics - {one.topic for one in stage.layers if one.heard}}")


def test_every_type_is_drawn_and_a_short_cloud_is_a_sentence(peer: Peer, watcher: Watcher) -> None:
    stage = Stage()
    said = messages()
    for topic, message in said.items():
        peer.publisher(topic, type(message), LATCHED).publish(message)
    until_heard(watcher, stage, set(said))
    troubles = {layer.topic: layer.refused for layer in stage.layers if layer.refused}
    assert troubles == {"/short_cloud": TOO_SHORT}
    assert stage.fixed == "odom"
    apart = {layer.topic for layer in stage.layers if layer.apart}
    # Nobody publishes where the sonar is.
    assert apart == {"/sensor/sonar_front"}
    picture = stage.picture(SpaceCamera(), 80, 40, None)
    tints = {*picture.front.ravel().tolist(), *picture.back.ravel().tolist()}
    assert {Tint.WALL, Tint.FREE, Tint.GOOD, Tint.SECOND} <= tints


def test_a_marker_is_deleted_by_the_next_message(peer: Peer, watcher: Watcher) -> None:
    stage = Stage()
    marker = messages()["/marker"]

    def shown() -> int:
        return sum(len(layer.reader.shown(0.0)) for layer in seen(watcher, stage).layers)

    with peer.saying("/marker", marker):
        wait_until(lambda: shown() == 1, "the marker")
    marker.action = 2
    with peer.saying("/marker", marker):
        wait_until(lambda: shown() == 0, "that it is gone")


def test_only_the_newest_of_large_clouds_is_decoded(peer: Peer, watcher: Watcher) -> None:
    stage = Stage()
    publisher = peer.publisher("/cloud", PointCloud2)
    large = in_frame(cloud(300_000))

    def is_asked_for() -> bool:
        return bool(seen(watcher, stage).layers.watched()) and bool(
            publisher.get_subscription_count()
        )

    wait_until(is_asked_for, "a subscription of the observer")
    for _time in range(3):
        publisher.publish(large)
    until_heard(watcher, stage, {"/cloud"})
    layer = stage.layers.get("/cloud")
    assert layer is not None
    assert layer.refused == ""
    (drawable,) = layer.reader.shown(0.0)
    assert len(drawable.shapes[0].places) == 300_000  # type: ignore[union-attr]
