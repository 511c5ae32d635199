"""The robot's model: where each of its links is, from a URDF and the positions of its joints.

/robot_description (latched) is the URDF, /tf_static has the links that are fixed, and /tf, for
whoever listens, those that move, `publish_frequency` times a second. A joint that others follow
(`<mimic>`) moves them, too. Without parameters it is the robot of the course. A position holds for
`hold_s`, as a head at rest reports once a second; after that the frame grows old, and whoever looks
at it sees that nobody knows where it is.
"""

from __future__ import annotations

import time
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from builtin_interfaces.msg import Time
from geometry_msgs.msg import TransformStamped
from rclpy.callback_groups import CallbackGroup
from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.subscription import Subscription
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage

from nodes.parts.node import LATCHED, LessonNode, NodeUsageError, Number, Switch, Text, change_period
from nodes.parts.runner import run
from robot.topics import HEAD_STATE, JOINT_STATES, ROBOT_DESCRIPTION, TF, TF_STATIC
from space.robot_model import JointType, ModelJoint, RobotModel, is_position
from space.transform import Transform
from space.urdf import UrdfError, read_urdf, urdf_of
from space.xml_elements import LONGEST
from text.i18n import N_
from text.os_words import os_reason
from text.sentences import reason_of

_QUEUE = QoSProfile(depth=50, reliability=ReliabilityPolicy.BEST_EFFORT)
"""From publishers of any reliability; several may share a topic, each with joints of its own."""
_SAY_EVERY_S = 5.0
_MOST_STRANGERS = 20
"""Unknown joints that are named: a driver may invent any number."""

_UNEVEN = N_("{topic} is ignored: it has {names} names and {positions} positions")
_ONLY_SPEEDS = N_("{topic} is ignored: it has speeds, but no positions of the joints")
_NOWHERE = N_("{topic}: {joint} cannot be at {position:g}; it is ignored")
_STRANGER = N_("{topic}: the robot has no joint {joint}; it is ignored")


@dataclass(frozen=True, slots=True)
class HeardPosition:
    """Where a joint was, radians or metres."""

    position: float
    stamp: Time
    """As its driver says."""
    heard_s: float
    """On the clock of `time.monotonic`."""


class JointPositions:
    """Subscribes to topics; what is not a position of a joint is said and ignored.

    Drivers report 50 times a second, and waking up is most of what hearing costs: messages wait in
    their queues until somebody takes them.
    """

    def __init__(self, node: LessonNode, topics: Collection[str], joints: Collection[str]) -> None:
        self._say = node.say
        self._joints = joints
        self._strangers: set[str] = set()
        self.heard: dict[str, HeardPosition] = {}
        unheard, quiet = _NeverWaitedFor(), SubscriptionEventCallbacks(use_default_callbacks=False)
        self._subscriptions: list[Subscription] = [
            node.create_subscription(
                JointState, topic, _never_called, _QUEUE, callback_group=unheard, event_callbacks=quiet
            )
            for topic in topics
        ]

    def take(self) -> None:
        """Take what has come since the last time."""
        for subscription in self._subscriptions:
            handle = subscription.handle
            with handle:
                # A publisher that is faster than this loop must not keep it busy for ever.
                for _ in range(_QUEUE.depth):
                    taken = handle.take_message(JointState, False)
                    if taken is None:
                        break
                    self._hear(subscription.topic_name, taken[0])

    def _hear(self, topic: str, message: JointState) -> None:
        names, positions = message.name, message.position
        if not positions:
            # A head that has not moved yet says that it does not know.
            if len(message.velocity):
                self._say.warn(_ONLY_SPEEDS, every_s=_SAY_EVERY_S, topic=topic)
            return
        if len(names) != len(positions):
            self._say.warn(_UNEVEN, every_s=_SAY_EVERY_S, topic=topic, names=len(names), positions=len(positions))
            return
        now_s = time.monotonic()
        for joint, position in zip(names, positions, strict=True):
            if joint not in self._joints:
                self._tell_stranger(topic, joint)
            elif is_position(position):
                self.heard[joint] = HeardPosition(position, message.header.stamp, now_s)
            else:
                self._say.warn(_NOWHERE, every_s=_SAY_EVERY_S, topic=topic, joint=joint, position=position)

    def _tell_stranger(self, topic: str, joint: str) -> None:
        if joint not in self._strangers and len(self._strangers) < _MOST_STRANGERS:
            self._strangers.add(joint)
            self._say.warn(_STRANGER, topic=topic, joint=joint)


class _NeverWaitedFor(CallbackGroup):
    """Subscriptions that the executor passes over."""

    def can_execute(self, _entity: object) -> bool:
        return False

    def beginning_execution(self, _entity: object) -> bool:
        return False

    def ending_execution(self, _entity: object) -> None:
        pass


def _never_called(_message: JointState) -> None:
    """Stand in for the callback that rclpy insists on."""


COURSE_ROBOT = Path(__file__).parents[1] / "robot" / "description" / "robot.urdf"
_LOOK_AFTER_S = 5.0
_IDLE_S = 0.2
"""How often to look whether somebody listens."""

_STARTED = N_("{robot}: {links} links, {moving} joints move; their positions come from {topics}")
_TWO = N_("give robot_description or urdf_file, not both")
_UNREADABLE = N_("cannot read {file}: {reason}; set the parameter urdf_file")
_NO_ROBOT = N_("{file}, {reason}")
_NO_LINK = N_("leave_out: the robot has no link {link}; its links are {links}")
_FREE = N_("joint {joint} is {kind}: the place of {link} has to come from a node of your own")
_SILENT = N_("Nobody has said where {joints} are: their links have no place; see {topics}")


class RobotStatePublisher(LessonNode):
    """Publishes what is fixed once, and what moves at a steady pace."""

    NAME = "robot_state_publisher"
    robot_description = Text("", "The robot as URDF; empty: see urdf_file", fixed=True, may_be_empty=True)
    urdf_file = Text("", "The file with the URDF; empty: the robot of the course", fixed=True, may_be_empty=True)
    publish_frequency = Number(20.0, "Messages on /tf", low=0.1, high=200.0, unit="Hz")
    joint_topics = Text(
        f"{JOINT_STATES} {HEAD_STATE}", "Topics with the positions of joints, with spaces between", fixed=True
    )
    leave_out = Text("", "Links whose place other nodes publish, with spaces between", fixed=True, may_be_empty=True)
    start_at_zero = Switch(False, "Whether a joint is at 0 until its position is heard")
    hold_s = Number(2.0, "How long a position holds", low=0.05, high=3600.0, unit="s")

    def __init__(self) -> None:
        super().__init__()
        text = self._description()
        self._model = self._read(text)
        topics = list(dict.fromkeys(self.joint_topics.split()))
        joints = self._published_joints()
        self._moving = {joint.name: joint for joint in joints if joint.movable}
        self._positions = JointPositions(self, topics, self._model.joints)
        self._told = self.create_publisher(String, ROBOT_DESCRIPTION, LATCHED)
        self._fixed = self.create_publisher(TFMessage, TF_STATIC, LATCHED)
        self._transforms = self.quick_publisher(TFMessage, TF)
        self._told.publish(String(data=text))
        self._publish_fixed([joint for joint in joints if joint.type is JointType.FIXED])
        self._tell_unmoved(joints)
        self._last_s = time.monotonic()
        self._period_s = _IDLE_S
        self._timer = self.every(_IDLE_S, self._tick)
        self._look = self.every(_LOOK_AFTER_S, self._miss_positions)
        self.say.info(
            _STARTED,
            robot=self._model.name,
            links=len(self._model.links),
            moving=len(self._moving),
            topics=", ".join(topics),
        )

    def contradiction(self, values: Mapping[str, Any]) -> str | None:
        return _TWO if values["robot_description"] and values["urdf_file"] else None

    # ---------------------------------------------------------------- at the start

    def _description(self) -> str:
        if given := self.robot_description:
            return given
        file = self._file
        try:
            with file.open("rb") as opened:
                return urdf_of(opened.read(LONGEST + 1))
        except UrdfError as error:
            raise NodeUsageError(_NO_ROBOT, file=file, reason=reason_of(error)) from None
        except (OSError, ValueError) as error:
            raise NodeUsageError(_UNREADABLE, file=file, reason=os_reason(error)) from None

    @property
    def _file(self) -> Path:
        return Path(self.urdf_file or COURSE_ROBOT).expanduser()

    def _read(self, text: str) -> RobotModel:
        source = "robot_description" if self.robot_description else self._file
        try:
            model = read_urdf(text)
        except UrdfError as error:
            raise NodeUsageError(_NO_ROBOT, file=source, reason=reason_of(error)) from None
        for warning in model.warnings:
            self.say.warn(_NO_ROBOT, file=source, reason=warning)
        return model

    def _published_joints(self) -> list[ModelJoint]:
        left_out = set(self.leave_out.split())
        for link in left_out - set(self._model.links):
            raise NodeUsageError(_NO_LINK, link=link, links=", ".join(self._model.links))
        return [joint for joint in self._model.joints.values() if joint.child not in left_out]

    def _publish_fixed(self, joints: list[ModelJoint]) -> None:
        now = self.get_clock().now().to_msg()
        self._fixed.publish(TFMessage(transforms=[_stamped(joint, joint.transform(0.0), now) for joint in joints]))

    def _tell_unmoved(self, joints: list[ModelJoint]) -> None:
        for joint in joints:
            if not joint.movable and joint.type is not JointType.FIXED:
                self.say.warn(_FREE, joint=joint.name, kind=joint.type.value, link=joint.child)

    def _miss_positions(self) -> None:
        self._look.cancel()
        known = self._known(time.monotonic())
        silent = [name for name, joint in self._moving.items() if joint.mimic is None and name not in known]
        if silent:
            topics = self.joint_topics
            self.say.warn(_SILENT, joints=", ".join(silent), topics=topics)

    # ---------------------------------------------------------------- at a pace

    def _tick(self) -> None:
        self._positions.take()
        listened = self._transforms.get_subscription_count() > 0
        period_s = 1.0 / self.publish_frequency if listened else _IDLE_S
        if period_s != self._period_s:
            self._period_s = period_s
            change_period(self._timer, period_s)
        since_s, self._last_s = self._last_s, time.monotonic()
        if listened:
            self._publish(since_s)

    def _publish(self, since_s: float) -> None:
        """Publish each joint: heard since then as its driver stamped it, held as it is now."""
        now = self.get_clock().now().to_msg()
        heard = self._positions.heard
        transforms = []
        for name, position in self._known(self._last_s).items():
            if name not in self._moving:
                continue
            source = heard.get(self._leader(name))
            fresh = source is not None and source.heard_s > since_s and _is_set(source.stamp)
            stamp = source.stamp if fresh and source is not None else now
            joint = self._moving[name]
            transforms.append(_stamped(joint, joint.transform(position), stamp))
        if transforms:
            self._transforms.publish(TFMessage(transforms=transforms))

    def _known(self, now_s: float) -> dict[str, float]:
        """Return the positions that hold now, by joint."""
        oldest_s = now_s - self.hold_s
        heard = self._positions.heard
        known = {name: one.position for name, one in heard.items() if one.heard_s > oldest_s}
        if self.start_at_zero:
            for name, joint in self._moving.items():
                if joint.mimic is None and name not in heard:
                    known[name] = 0.0
        return self._model.followed(known)

    def _leader(self, name: str) -> str:
        """Return whose position moves a joint: its own, or that of the joint that it follows."""
        while name not in self._positions.heard:
            mimic = self._model.joints[name].mimic
            if mimic is None:
                break
            name = mimic.joint
        return name


def _stamped(joint: ModelJoint, transform: Transform, stamp: Time) -> TransformStamped:
    message = TransformStamped()
    message.header.stamp = stamp
    message.header.frame_id, message.child_frame_id = joint.parent, joint.child
    place, turn = message.transform.translation, message.transform.rotation
    place.x, place.y, place.z = transform.translation
    turn.x, turn.y, turn.z, turn.w = transform.rotation
    return message


def _is_set(stamp: Time) -> bool:
    return bool(stamp.sec or stamp.nanosec)


if __name__ == "__main__":
    raise SystemExit(run(RobotStatePublisher))
