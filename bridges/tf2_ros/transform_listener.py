"""From the topics into a buffer."""

from __future__ import annotations

import contextlib
from threading import Thread
from typing import TYPE_CHECKING, Any

from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile
from tf2_msgs.msg import TFMessage

if TYPE_CHECKING:
    from tf2_ros.buffer import Buffer

DEFAULT_TF_TOPIC = "/tf"
DEFAULT_STATIC_TF_TOPIC = "/tf_static"
_WHO = "default_authority"


class TransformListener:
    """Puts what is published on /tf and /tf_static into a buffer."""

    def __init__(
        self,
        buffer: Buffer,
        node: Node | None,
        *,
        spin_thread: bool = False,
        qos: QoSProfile | int | None = None,
        static_qos: QoSProfile | int | None = None,
        tf_topic: str = DEFAULT_TF_TOPIC,
        tf_static_topic: str = DEFAULT_STATIC_TF_TOPIC,
        static_only: bool = False,
    ) -> None:
        self.buffer = buffer
        buffer.is_filled = True
        self.node = node if node is not None else self._own_node()
        # A callback that waits for a transform must not hold up the one that brings it.
        self.group = ReentrantCallbackGroup()
        if not static_only:
            self.tf_sub = self.node.create_subscription(
                TFMessage,
                tf_topic,
                self.callback,
                _qos(DurabilityPolicy.VOLATILE) if qos is None else qos,
                callback_group=self.group,
            )
        self.tf_static_sub = self.node.create_subscription(
            TFMessage,
            tf_static_topic,
            self.static_callback,
            _qos(DurabilityPolicy.TRANSIENT_LOCAL) if static_qos is None else static_qos,
            callback_group=self.group,
        )
        if spin_thread:
            self.executor = SingleThreadedExecutor(context=self.node.context)
            self.dedicated_listener_thread = Thread(target=_spin, args=(self.executor, self.node), daemon=True)
            self.dedicated_listener_thread.start()

    def callback(self, data: Any) -> None:
        """Keep transforms of their time."""
        for transform in data.transforms:
            self.buffer.set_transform(transform, _WHO)

    def static_callback(self, data: Any) -> None:
        """Keep transforms that hold at any time."""
        for transform in data.transforms:
            self.buffer.set_transform_static(transform, _WHO)

    def unregister(self) -> None:
        for name in ("tf_sub", "tf_static_sub"):
            if (found := self.__dict__.pop(name, None)) is not None:
                self.node.destroy_subscription(found)

    def __del__(self) -> None:
        # At the end of a program the middleware may be gone before this is.
        with contextlib.suppress(Exception):
            if "executor" in self.__dict__:
                self.executor.shutdown()
                self.dedicated_listener_thread.join()
            self.unregister()

    def _own_node(self) -> Node:
        return Node(
            f"transform_listener_impl_{id(self):010x}",
            enable_rosout=False,
            start_parameter_services=False,
            parameter_overrides=[Parameter("use_sim_time", value=False)],
        )


def _qos(durability: DurabilityPolicy) -> QoSProfile:
    return QoSProfile(depth=100, durability=durability, history=HistoryPolicy.KEEP_LAST)


def _spin(executor: SingleThreadedExecutor, node: Node) -> None:
    executor.add_node(node)
    with contextlib.suppress(ExternalShutdownException):
        executor.spin()
    executor.remove_node(node)
