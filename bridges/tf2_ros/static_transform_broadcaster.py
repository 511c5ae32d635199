"""A publisher of where frames are for good."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile
from tf2_msgs.msg import TFMessage

from tf2_ros.transform_broadcaster import as_list

if TYPE_CHECKING:
    from rclpy.node import Node


class StaticTransformBroadcaster:
    """Publishes on /tf_static where a frame is for good; who comes later hears it, too."""

    def __init__(self, node: Node, qos: QoSProfile | int | None = None) -> None:
        if qos is None:
            qos = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL, history=HistoryPolicy.KEEP_LAST)
        self.pub_tf = node.create_publisher(TFMessage, "/tf_static", qos)
        self.net_message = TFMessage()

    def sendTransform(self, transform: Any) -> None:  # noqa: N802 - tf2's own name
        """Publish a TransformStamped, or a list of them, together with all earlier ones."""
        # Only the last message is kept for those who come later, so it has to hold all frames.
        frames = {each.child_frame_id: each for each in self.net_message.transforms}
        frames |= {each.child_frame_id: each for each in as_list(transform)}
        self.net_message = TFMessage(transforms=list(frames.values()))
        self.pub_tf.publish(self.net_message)
