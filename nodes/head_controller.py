"""The pan and tilt head: a service that takes its time, without anybody having to wait for it.

Request: `a` pan, `b` tilt, whole degrees from -90 to 90, + is left and up. Answer: `sum` 1 when
the head is there, 0 when the request was refused. A request that comes while the head moves waits
for its turn; more than `queue` waiting ones are refused. The movement is spread over `move_time`
seconds and shown on /head_state in radians.
"""

from __future__ import annotations

import math
import sys
import time
from collections import deque
from dataclasses import dataclass

from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.task import Future
from sensor_msgs.msg import JointState

from nodes._life import run
from nodes._node import LessonNode, change_period
from nodes._parameters import Number, Whole
from nodes._speech import Phrase
from nodes._topics import DEPTH, HEAD_SERVICE, HEAD_STATE
from robot.limits import HEAD_ANGLE

JOINTS = ("pan_joint", "tilt_joint")

_STARTED = Phrase("The head is ready for {service}", "Голова готова, сервис {service}")
_TURNING = Phrase(
    "Turning the head to pan {pan}°, tilt {tilt}°", "Поворачиваю голову: pan {pan}°, tilt {tilt}°"
)
_DONE = Phrase(
    "The head is there: pan {pan}°, tilt {tilt}°", "Голова на месте: pan {pan}°, tilt {tilt}°"
)
_WAITING = Phrase(
    "The head is moving; pan {pan}°, tilt {tilt}° waits for its turn",
    "Голова движется; pan {pan}°, tilt {tilt}° ждёт своей очереди",
)
_OUT_OF_RANGE = Phrase(
    "Refused: pan {pan}°, tilt {tilt}° — both must be from {low:g}° to {high:g}°",
    "Отказ: pan {pan}°, tilt {tilt}° — нужно от {low:g}° до {high:g}°",
)
_BUSY = Phrase(
    "Refused: pan {pan}°, tilt {tilt}° — {count} requests are waiting already",
    "Отказ: pan {pan}°, tilt {tilt}° — в очереди уже {count}",
)


@dataclass(frozen=True)
class Pose:
    """Where the head looks, in degrees."""

    pan: float
    tilt: float

    def towards(self, goal: Pose, share: float) -> Pose:
        """The pose at a share (0..1) of the way to another one."""
        return Pose(
            self.pan + (goal.pan - self.pan) * share, self.tilt + (goal.tilt - self.tilt) * share
        )


class HeadController(LessonNode):
    """Moves one request at a time."""

    NAME = "head_controller"
    SETTINGS = (
        Number("move_time", 1.0, "How long a movement takes", low=0.0, high=30.0, unit="s"),
        Number("rate", 20.0, "/head_state while it moves", low=1.0, high=100.0, unit="Hz"),
        Number("rest_rate", 1.0, "/head_state while it rests", low=0.1, high=100.0, unit="Hz"),
        Whole("queue", 4, "Requests that may wait", low=0, high=64),
    )

    def __init__(self) -> None:
        super().__init__()
        self._pose = self._from = self._goal = Pose(0, 0)
        self._began_s = 0.0
        self._turns: deque[tuple[Pose, Future]] = deque()
        """The first one is being moved to."""
        self._publisher = self.create_publisher(JointState, HEAD_STATE, DEPTH)
        # The request awaits the movement: it must not keep the timer's callback group.
        self.create_service(
            AddTwoInts, HEAD_SERVICE, self._serve, callback_group=ReentrantCallbackGroup()
        )
        self._timer = self.every(1.0 / self.number("rest_rate"), self._tick)
        self.say.info(_STARTED, service=HEAD_SERVICE)

    def parameters_changed(self) -> None:
        """Keep the new rates."""
        self._set_pace()

    async def _serve(
        self, request: AddTwoInts.Request, response: AddTwoInts.Response
    ) -> AddTwoInts.Response:
        response.sum = 0
        asked = {"pan": request.a, "tilt": request.b}
        if request.a not in HEAD_ANGLE or request.b not in HEAD_ANGLE:
            self.say.warn(_OUT_OF_RANGE, low=HEAD_ANGLE.low, high=HEAD_ANGLE.high, **asked)
            return response
        if len(self._turns) > self.number("queue"):
            self.say.warn(_BUSY, count=len(self._turns) - 1, **asked)
            return response
        arrival = Future()
        self._turns.append((Pose(request.a, request.b), arrival))
        if len(self._turns) == 1:
            self._begin()
        else:
            self.say.info(_WAITING, **asked)
        response.sum = int(await arrival)
        return response

    def _begin(self) -> None:
        self._from, self._goal = self._pose, self._turns[0][0]
        self._began_s = time.monotonic()
        self._set_pace()
        self.say.info(_TURNING, pan=self._goal.pan, tilt=self._goal.tilt)

    def _tick(self) -> None:
        if self._turns:
            self._move()
        self._publish()

    def _move(self) -> None:
        move_time_s = self.number("move_time")
        passed_s = time.monotonic() - self._began_s
        if passed_s < move_time_s:
            self._pose = self._from.towards(self._goal, passed_s / move_time_s)
            return
        self._pose = self._goal
        self.say.info(_DONE, pan=self._goal.pan, tilt=self._goal.tilt)
        _goal, arrival = self._turns.popleft()
        arrival.set_result(True)
        if self._turns:
            self._begin()
        else:
            self._set_pace()

    def _set_pace(self) -> None:
        change_period(self._timer, 1.0 / self.number("rate" if self._turns else "rest_rate"))

    def _publish(self) -> None:
        message = JointState()
        message.header.stamp = self.get_clock().now().to_msg()
        message.name = list(JOINTS)
        message.position = [math.radians(self._pose.pan), math.radians(self._pose.tilt)]
        self._publisher.publish(message)


def main(args: list[str] | None = None) -> int:
    """Run the node until it is asked to end."""
    return run(HeadController, args)


if __name__ == "__main__":
    sys.exit(main())
