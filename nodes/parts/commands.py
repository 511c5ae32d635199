"""What nodes share that pass drive commands on: the messages, and what is wrong with one or with its way.

A command with a number beyond the limits, or with a stamp from another time, is refused, and a
refused command counts as a stop. That holds for the gate, the electronic differential and the
chassis alike; none of them trusts the previous one.
"""

from __future__ import annotations

import math
import time
from collections import Counter
from typing import NamedTuple

from ackermann_msgs.msg import AckermannDriveStamped
from builtin_interfaces.msg import Time
from rclpy.duration import Duration

from nodes.parts.node import LessonNode, Number
from robot.limits import PICO_RAD_S, Limits, first_excess
from robot.words import DriveSetpoint
from text.i18n import N_

FRAME = "base_link"
LAST_STOP = Duration(seconds=0.2)
"""How long the last stop of a node that ends may take to reach all subscribers."""


def to_message(node: LessonNode, setpoint: DriveSetpoint) -> AckermannDriveStamped:
    """Build a message stamped now."""
    message = AckermannDriveStamped()
    message.header.stamp = node.get_clock().now().to_msg()
    message.header.frame_id = FRAME
    message.drive.speed = float(setpoint.speed_m_s)
    message.drive.steering_angle = float(setpoint.steering_rad)
    return message


def from_message(message: AckermannDriveStamped) -> DriveSetpoint:
    """Return its command; values are taken unchanged, nan included."""
    return DriveSetpoint(message.drive.speed, message.drive.steering_angle)


MAX_WHEEL_SPEED = Number(
    PICO_RAD_S, "As the Pico has it; both wheels are slowed to it", low=0.1, high=200.0, unit="rad/s"
)
"""The parameter of nodes that command the wheels."""

_REMEMBER_S = 1.5
"""How long the state reports a refusal: a little longer than its period."""
_LONGEST_WAY_S = 2.0
"""The maximum transport delay of a command, for nodes without an age limit."""
_AHEAD_S = 0.5
_ANOTHER_CLOCK_S = 30.0
"""No message takes this long to arrive: a greater difference comes from the clocks."""

_NO_NUMBER = N_("{source} asks for {value:g} {unit}, which is not a number: refused, stop")
_BEYOND = N_("{source} asks for {value:g} {unit}, the limit is {limit:g} {unit}: refused, stop")
_UNITS = {"m/s": N_("m/s"), "rad": N_("rad"), "rad/s": N_("rad/s")}
_OLD = N_("A command of {source} is {age:.1f} s old by its stamp and is not obeyed")
_OTHER_CLOCK = N_(
    "The stamps of {source} are {age:.1f} s {which} this computer's clock: it is not obeyed;"
    " set the clocks of both computers (chrony, NTP), or leave the stamps at zero"
)
_BEHIND, _AHEAD = N_("behind"), N_("ahead of")
_SHORT = N_("{value:g} {unit}, limit {limit:g} {unit}")
_SHORT_STAMP = N_("stamp {age:.1f} s old")


class Refusal(NamedTuple):
    """A refused command, in a few words."""

    told: str
    """For programs, in English."""
    words: str
    """For people."""


class CommandRefusals:
    """The recent refusals of this node."""

    def __init__(self, node: LessonNode) -> None:
        """Log through `node`, and use its clock."""
        self._node = node
        self._last: Refusal | None = None
        self._at_s = -math.inf

    @property
    def recent(self) -> Refusal | None:
        """Return the last recent refusal, None if there is none."""
        return self._last if time.monotonic() - self._at_s < _REMEMBER_S else None

    def beyond(self, source: str, *asked: tuple[float, Limits]) -> bool:
        """Whether one of these values is not a number or beyond its limits; that is logged."""
        excess = first_excess(*asked)
        if excess is None:
            return False
        say = self._node.say
        value, limit = excess.value, excess.limits.high
        unit = say.text(_UNITS[excess.limits.unit])
        self._remember(str(excess), say.text(_SHORT, value=value, unit=unit, limit=limit))
        phrase = _BEYOND if math.isfinite(value) else _NO_NUMBER
        say.error(phrase, every_s=1.0, source=source, value=value, unit=unit, limit=limit)
        return True

    def untimely(self, source: str, stamp: Time, max_age_s: float) -> bool:
        """Whether its stamp is older than that, or in the future; a stamp of zero is ignored.

        Even with a `max_age_s` of 0 it must not have been under way for seconds.
        """
        if not (stamp.sec or stamp.nanosec):
            return False
        now_s = self._node.get_clock().now().nanoseconds * 1e-9
        age_s = now_s - stamp.sec - stamp.nanosec * 1e-9
        if -_AHEAD_S <= age_s <= (max_age_s or _LONGEST_WAY_S):
            return False
        say = self._node.say
        self._remember(f"stamp {age_s:.1f} s old", say.text(_SHORT_STAMP, age=age_s))
        if 0 < age_s < _ANOTHER_CLOCK_S:
            say.warn(_OLD, every_s=1.0, source=source, age=age_s)
        else:
            which = say.text(_BEHIND if age_s > 0 else _AHEAD)
            say.error(_OTHER_CLOCK, every_s=1.0, source=source, age=abs(age_s), which=which)
        return True

    def _remember(self, told: str, words: str) -> None:
        self._last, self._at_s = Refusal(told, words), time.monotonic()


_DRAIN_S = 0.5
"""How long it takes to deliver what has waited, on a machine that is also busy."""
_DRAIN_UNDER_LOAD_S = 3.0


class StallDetector:
    """Whether this process was held up, so that waiting messages may be older than they seem.

    A process that was suspended or starved for seconds finds commands and readings in its queues that
    seem new: a drive command whose stop waits behind it. So it ignores all messages for a moment. A
    machine under load may need longer than that to deliver what has waited; then the stamp of a message
    shows its age, if it has one. Clocks of two machines differ, so stamps are checked only for the
    first seconds.

    Ask it in every callback and from a timer: the time between two calls is the time asleep.
    """

    def __init__(self) -> None:
        self._last_s = time.monotonic()
        self._woke_s = -math.inf

    def lasted(self, longest_s: float) -> bool:
        """Return whether to ignore messages now, after a sleep of more than `longest_s`."""
        now_s = time.monotonic()
        if now_s - self._last_s > longest_s:
            self._woke_s = now_s
        self._last_s = now_s
        return now_s - self._woke_s < _DRAIN_S

    def kept_waiting(self, stamp: Time) -> bool:
        """Return whether a message with this stamp was sent while this process slept."""
        awake_s = time.monotonic() - self._woke_s
        if awake_s > _DRAIN_UNDER_LOAD_S or not (stamp.sec or stamp.nanosec):
            return False
        age_s = time.time() - stamp.sec - stamp.nanosec * 1e-9
        return bool(awake_s < age_s < _ANOTHER_CLOCK_S)


_WATCH_S = 5.0
"""A source first heard later than this after the start was also started later."""


class FirstHeard:
    """Whether a node that has just started may have missed a latched message of an undiscovered node.

    Discovery takes tenths of a second, sometimes seconds, and a latched message arrives a little later;
    the command of another node may come first. A source that was already sending when the node started
    is recognised by its first message, which is among the first messages received.
    """

    def __init__(self) -> None:
        self._started_s = self._newest_s = time.monotonic()
        self._known: set[str] = set()

    def hear(self, name: str) -> None:
        """Note a message of this source, perhaps not its first."""
        now_s = time.monotonic()
        if name not in self._known and now_s - self._started_s < _WATCH_S:
            self._newest_s = now_s
        self._known.add(name)

    @property
    def quiet_s(self) -> float:
        """Return the seconds since the start, or since the last new source."""
        return time.monotonic() - self._newest_s


_LOOK_EVERY_S = 1.0
_SAY_EVERY_S = 10.0
_NAMELESS = "_NODE_NAME_UNKNOWN_"
"""Source: rmw, `get_topic_endpoint_info.h`."""
_NAMED_WITHIN_S = 3.0
"""The name of an endpoint is known a little later than the endpoint; that of a program without a
ROS node never is."""
_FOUND_WITHIN_S = 5.0
"""Endpoints found this soon after the start may be left over from a dead node of this name."""
_FORGOTTEN_S = 25.0
"""By then the middleware has removed such an endpoint."""

SLOWEST = N_("{topic} is also published by {others}: the slowest command counts")
LOWEST = N_("{topic} is published by several, {others}: the lowest distance counts")
_NO_NODE = N_("a program without a node's name")
_NAMESAKE = N_("another {name}")


class SolePublisher:
    """Looks once a second whether another node publishes what only one should, and names it.

    ROS lets anybody publish anything; a node can only name who does. It does not refuse to run: the
    endpoint of a killed node stays for up to 20 s, and its successor must drive.
    """

    def __init__(self, node: LessonNode, topic: str, *, own: bool = False, others: str) -> None:
        """Say `others` of them; `own`: the node publishes it itself, else one other may."""
        self._node, self._topic, self._words = node, topic, others
        self._own = node.get_fully_qualified_name() if own else ""
        self._began_s = time.monotonic()
        self._seen_s: dict[str, float] = {}
        self._told: frozenset[str] = frozenset()
        node.every(_LOOK_EVERY_S, self._look)

    def _look(self) -> None:
        others = self._others() if self._node.count_publishers(self._topic) > 1 else []
        if not self._own and len(others) < 2:
            # One that was started again: what is left of its last run is in the graph for a while.
            others = []
        if others:
            every_s = 0.0 if frozenset(others) - self._told else _SAY_EVERY_S
            names = ", ".join(sorted(others))
            self._node.say.warn(self._words, every_s=every_s, topic=self._topic, others=names)
        self._told = frozenset(others)

    def _others(self) -> list[str]:
        names = Counter(
            f"{one.node_namespace.rstrip('/')}/{one.node_name}"
            for one in self._node.get_publishers_info_by_topic(self._topic)
        )
        if self._own:
            names[self._own] -= 1
        now_s = time.monotonic()
        self._seen_s = {name: self._seen_s.get(name, now_s) for name in +names}
        return [self._called(name) for name, at_s in self._seen_s.items() if self._is_sure(name, at_s)]

    def _is_sure(self, name: str, seen_s: float) -> bool:
        now_s = time.monotonic()
        if name.endswith(_NAMELESS):
            return now_s - seen_s > _NAMED_WITHIN_S
        left_over = name == self._own and seen_s - self._began_s < _FOUND_WITHIN_S
        return not left_over or now_s - self._began_s > _FORGOTTEN_S

    def _called(self, name: str) -> str:
        if name.endswith(_NAMELESS):
            return self._node.say.text(_NO_NODE)
        return self._node.say.text(_NAMESAKE, name=name) if name == self._own else name
