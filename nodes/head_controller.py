"""The pan and tilt head: a slow service that does not block anything else.

Request: `a` pan, `b` tilt, whole degrees from -90 to 90, + is left and up. Response: `sum` 1 when
the head has arrived, 0 if the request was refused. A request that comes while the head moves waits
for its turn; requests beyond `queue` waiting ones are refused.

Without a `port` the head is simulated: a movement takes `move_time` seconds. With one, an LSC-16
moves two servos at `speed`; nothing moves before the first request, and requests are refused while
the controller does not answer. /head_state (radians) is the commanded position, as the servos do
not report theirs; it is empty while the position is unknown: before the first movement, and after
the controller was away.
"""

from __future__ import annotations

import math
import sys
import time
from collections import deque
from dataclasses import dataclass
from typing import TYPE_CHECKING

from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.task import Future
from sensor_msgs.msg import JointState

from nodes.drivers import head_words as words
from nodes.drivers.servos import WAS_AWAY, ServoClient
from nodes.parts.diagnostics import tell_every_second
from nodes.parts.node import LessonNode, change_period
from nodes.parts.parameters import Number, Whole
from nodes.parts.qos import DEPTH
from nodes.parts.runner import run
from robot.joints import HEAD_JOINTS
from robot.motion.head import turn_ms
from robot.topics import HEAD_SERVICE, HEAD_STATE

if TYPE_CHECKING:
    from collections.abc import Mapping

    from nodes.parts.parameters import Value

_SETTLE_S = 0.1
"""A command takes 14 ms on the wire, and a servo lags behind its command."""


@dataclass(frozen=True)
class HeadPose:
    """The direction of the head, in degrees."""

    pan: float
    tilt: float

    def towards(self, goal: HeadPose, share: float) -> HeadPose:
        """Return the pose at a share (0..1) of the way to another one."""
        return HeadPose(self.pan + (goal.pan - self.pan) * share, self.tilt + (goal.tilt - self.tilt) * share)


class HeadController(LessonNode):
    """Moves one request at a time."""

    NAME = "head_controller"
    SETTINGS = (
        Number("move_time", 1.0, "How long a simulated movement takes", high=30.0, unit="s"),
        Number("rate", 20.0, "/head_state while it moves", low=1.0, high=100.0, unit="Hz"),
        Number("rest_rate", 1.0, "/head_state while it rests", low=0.1, high=100.0, unit="Hz"),
        Whole("queue", 4, "Requests that may wait", low=0, high=64),
        *words.SERVO_SETTINGS,
    )

    def __init__(self) -> None:
        super().__init__()
        self._servos = ServoClient(self) if self.text("port") else None
        self._pose = self._from = HeadPose(0, 0) if self._servos is None else None
        """None if unknown."""
        self._pulses_us: tuple[int, int] | None = None
        """The last command to the servos."""
        self._began_s = self._length_s = 0.0
        self._turns: deque[tuple[HeadPose, Future]] = deque()
        """The first request is being carried out."""
        self._read_joints()
        self._publisher = self.create_publisher(JointState, HEAD_STATE, DEPTH)
        # A request waits for its movement: it must not block the timer's callback group.
        self.create_service(AddTwoInts, HEAD_SERVICE, self._serve, callback_group=ReentrantCallbackGroup())
        self._timer = self.every(1.0 / self.number("rest_rate"), self._tick)
        if self._servos is None:
            self.say.info(words.STARTED, service=HEAD_SERVICE)
        else:
            self._start(self._servos)

    def contradiction(self, values: Mapping[str, Value]) -> str | None:
        """Refuse two joints at one servo, or a joint without a range."""
        return words.contradiction(values)

    def parameters_changed(self) -> None:
        """Apply the new rates; a new trim applies from the next movement on."""
        self._read_joints()
        self._set_pace()

    def before_end(self) -> None:
        """Release the port; a movement that has begun finishes by itself."""
        if self._servos is not None:
            self._servos.link.close()

    def _start(self, servos: ServoClient) -> None:
        tell_every_second(self, lambda: servos.status(self.get_name()))
        self.say.info(words.STARTED_AT_PORT, port=servos.link.port, service=HEAD_SERVICE)
        servos.link.start()

    def _read_joints(self) -> None:
        self._pan, self._tilt = (words.joint(self._values, name) for name in ("pan", "tilt"))

    # ---------------------------------------------------------------- requests

    async def _serve(self, request: AddTwoInts.Request, response: AddTwoInts.Response) -> AddTwoInts.Response:
        response.sum = 0
        asked = HeadPose(request.a, request.b)
        if not self._reaches(asked):
            return response
        if self._servos is not None:
            self._look_after(self._servos)
            trouble = self._servos.trouble()
            if trouble is not None:
                self._refuse(words.NO_HEAD, asked, reason=trouble)
                return response
        if len(self._turns) > self.number("queue"):
            self._refuse(words.BUSY, asked, count=len(self._turns) - 1)
            return response
        arrival = Future()
        self._turns.append((asked, arrival))
        if len(self._turns) == 1:
            self._begin()
        else:
            self.say.info(words.WAITING, pan=asked.pan, tilt=asked.tilt)
        response.sum = int(await arrival)
        return response

    def _reaches(self, asked: HeadPose) -> bool:
        pan, tilt = self._pan.reach, self._tilt.reach
        if asked.pan in pan and asked.tilt in tilt:
            return True
        self._refuse(
            words.OUT_OF_RANGE, asked, pan_low=pan.low, pan_high=pan.high, tilt_low=tilt.low, tilt_high=tilt.high
        )
        return False

    def _refuse(self, phrase: str, asked: HeadPose, **values: object) -> None:
        self.say.warn(phrase, every_s=0.0, pan=asked.pan, tilt=asked.tilt, **values)

    # ---------------------------------------------------------------- movements

    def _begin(self) -> None:
        """Start the first request that can be carried out, if there is one."""
        # The trim may have changed since the request came.
        while self._turns and not self._reaches(self._turns[0][0]):
            self._answer(arrived=False)
        self._set_pace()
        if not self._turns:
            return
        goal = self._turns[0][0]
        self._from, self._began_s = self._pose, time.monotonic()
        if self._servos is None:
            self._length_s = self.number("move_time")
        elif not self._command(self._servos, goal):
            self._give_up(self._servos)
            return
        self.say.info(words.TURNING, pan=goal.pan, tilt=goal.tilt)

    def _command(self, servos: ServoClient, goal: HeadPose) -> bool:
        pan, tilt = self._pan, self._tilt
        pan_us, tilt_us = self._pulses_us or (None, None)
        way_deg = max(pan.way_deg(pan_us, goal.pan), tilt.way_deg(tilt_us, goal.tilt))
        time_ms = turn_ms(way_deg, self.number("speed"))
        self._length_s = time_ms / 1000 + _SETTLE_S
        self._pulses_us = pan.pulse_us(goal.pan), tilt.pulse_us(goal.tilt)
        pairs = zip((pan.servo, tilt.servo), self._pulses_us, strict=True)
        return servos.move(tuple(pairs), time_ms)

    def _look_after(self, servos: ServoClient) -> None:
        if servos.was_away():
            self._give_up(servos)

    def _give_up(self, servos: ServoClient) -> None:
        """Fail: the direction of the head is no longer known."""
        self._pose = self._pulses_us = None
        if not self._turns:
            return
        reason = servos.trouble() or self.say.text(WAS_AWAY)
        while self._turns:
            self._refuse(words.NO_HEAD, self._turns[0][0], reason=reason)
            self._answer(arrived=False)
        self._set_pace()

    def _answer(self, *, arrived: bool) -> None:
        _goal, arrival = self._turns.popleft()
        arrival.set_result(arrived)

    def _tick(self) -> None:
        if self._servos is not None:
            self._look_after(self._servos)
        if self._turns:
            self._move()
        self._publish()

    def _move(self) -> None:
        goal = self._turns[0][0]
        passed_s = time.monotonic() - self._began_s
        if passed_s < self._length_s:
            if self._from is not None:
                self._pose = self._from.towards(goal, passed_s / self._length_s)
            return
        self._pose = goal
        self.say.info(words.DONE, pan=goal.pan, tilt=goal.tilt)
        self._answer(arrived=True)
        self._begin()

    def _set_pace(self) -> None:
        change_period(self._timer, 1.0 / self.number("rate" if self._turns else "rest_rate"))

    def _publish(self) -> None:
        message = JointState()
        message.header.stamp = self.get_clock().now().to_msg()
        message.name = list(HEAD_JOINTS)
        if self._pose is not None:
            message.position = [math.radians(self._pose.pan), math.radians(self._pose.tilt)]
        self._publisher.publish(message)


def main(args: list[str] | None = None) -> int:
    """Run the node until it is asked to end."""
    return run(HeadController, args)


if __name__ == "__main__":
    sys.exit(main())
