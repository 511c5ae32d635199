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
import time
from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.task import Future
from sensor_msgs.msg import JointState

from nodes.drivers.diagnostics import tell_every_second
from nodes.drivers.servos import WAS_AWAY, ServoClient
from nodes.parts.node import DEPTH, LessonNode, Number, Switch, Text, Whole, change_period
from nodes.parts.runner import run
from robot.joints import HEAD_JOINTS
from robot.limits import HEAD_ANGLE, Limits
from robot.motion.head import HeadJoint, turn_ms
from robot.topics import HEAD_SERVICE, HEAD_STATE
from robot.wire.lsc16 import BAUD, SERVO
from text.i18n import N_

_SETTLE_S = 0.1
"""A command takes 14 ms on the wire, and a servo lags behind its command."""

_STARTED = N_("The head is ready for {service}")
_STARTED_AT_PORT = N_(
    "The head at {port}: {service}; /head_state is the commanded position, as servos do not report theirs"
)
_TURNING = N_("Turning the head to pan {pan}°, tilt {tilt}°")
_DONE = N_("The head is there: pan {pan}°, tilt {tilt}°")
_WAITING = N_("The head is moving; pan {pan}°, tilt {tilt}° waits for its turn")
_OUT_OF_RANGE = N_(
    "Refused: pan {pan}°, tilt {tilt}° — pan must be from {pan_low:g}° to {pan_high:g}°,"
    " tilt from {tilt_low:g}° to {tilt_high:g}°"
)
_BUSY = N_("Refused: pan {pan}°, tilt {tilt}° — {count} requests are waiting already")
_NO_HEAD = N_("Refused: pan {pan}°, tilt {tilt}° — {reason}")

_SAME_SERVO = N_("pan_servo and tilt_servo are both {pan_servo}; each joint has a servo of its own")
_NO_ROOM = {
    "pan": N_("nothing is left between pan_min and pan_max, with pan_trim {pan_trim:g}"),
    "tilt": N_("nothing is left between tilt_min and tilt_max, with tilt_trim {tilt_trim:g}"),
}


def _servo(default: int, about: str) -> Whole:
    return Whole(default, about, fixed=True, low=int(SERVO.low), high=int(SERVO.high))


def _angle(default: float, about: str) -> Number:
    return Number(float(default), about, fixed=True, low=HEAD_ANGLE.low, high=HEAD_ANGLE.high, unit="deg")


def _trim(about: str) -> Number:
    return Number(0.0, about, low=-45.0, high=45.0, unit="deg")


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
    move_time = Number(1.0, "How long a simulated movement takes", high=30.0, unit="s")
    rate = Number(20.0, "/head_state while it moves", low=1.0, high=100.0, unit="Hz")
    rest_rate = Number(1.0, "/head_state while it rests", low=0.1, high=100.0, unit="Hz")
    queue = Whole(4, "Requests that may wait", low=0, high=64)
    port = Text("", "Port of an LSC-16, as in /dev/serial/by-id; empty: simulated", fixed=True, may_be_empty=True)
    baud = Whole(BAUD, "Speed of the port", fixed=True, low=9600, high=921_600)
    speed = Number(90.0, "Speed of the servos, with a port", low=10.0, high=360.0, unit="deg/s")
    pan_servo = _servo(1, N_("Channel of the pan servo"))
    pan_min = _angle(HEAD_ANGLE.low, N_("Minimum pan"))
    pan_max = _angle(HEAD_ANGLE.high, N_("Maximum pan"))
    pan_trim = _trim(N_("Angle of the pan servo at which the head looks straight ahead"))
    pan_reversed = Switch(False, "Whether a longer pulse turns the head right", fixed=True)
    tilt_servo = _servo(2, N_("Channel of the tilt servo"))
    tilt_min = _angle(HEAD_ANGLE.low, N_("Minimum tilt"))
    tilt_max = _angle(HEAD_ANGLE.high, N_("Maximum tilt"))
    tilt_trim = _trim(N_("Angle of the tilt servo at which the head looks straight ahead"))
    tilt_reversed = Switch(False, "Whether a longer pulse turns the head down", fixed=True)
    servo_turn = Number(
        180.0,
        "Travel of a servo from its shortest to its longest pulse",
        fixed=True,
        low=90.0,
        high=360.0,
        unit="deg",
    )
    battery_every_s = Number(
        1.0,
        "How often to ask for the voltage, to check the controller; 0: never",
        fixed=True,
        low=0.0,
        high=60.0,
        unit="s",
    )
    battery_low = Number(6.0, "Below this it warns", low=0.0, high=30.0, unit="V")

    def __init__(self) -> None:
        super().__init__()
        self._servos = ServoClient(self) if self.port else None
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
        self._timer = self.every(1.0 / self.rest_rate, self._tick)
        if self._servos is None:
            self.say.info(_STARTED, service=HEAD_SERVICE)
        else:
            self._start(self._servos)

    def contradiction(self, values: Mapping[str, Any]) -> str | None:
        """Refuse two joints at one servo, or a joint without a range."""
        if values["pan_servo"] == values["tilt_servo"]:
            return _SAME_SERVO
        for name, phrase in _NO_ROOM.items():
            reach = _joint(values, name).reach
            if reach.low >= reach.high:
                return phrase
        return None

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
        self.say.info(_STARTED_AT_PORT, port=servos.link.port, service=HEAD_SERVICE)
        servos.link.start()

    def _read_joints(self) -> None:
        self._pan, self._tilt = (_joint(self.values, name) for name in ("pan", "tilt"))

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
                self._refuse(_NO_HEAD, asked, reason=trouble)
                return response
        if len(self._turns) > self.queue:
            self._refuse(_BUSY, asked, count=len(self._turns) - 1)
            return response
        arrival = Future()
        self._turns.append((asked, arrival))
        if len(self._turns) == 1:
            self._begin()
        else:
            self.say.info(_WAITING, pan=asked.pan, tilt=asked.tilt)
        response.sum = int(await arrival)
        return response

    def _reaches(self, asked: HeadPose) -> bool:
        pan, tilt = self._pan.reach, self._tilt.reach
        if asked.pan in pan and asked.tilt in tilt:
            return True
        self._refuse(_OUT_OF_RANGE, asked, pan_low=pan.low, pan_high=pan.high, tilt_low=tilt.low, tilt_high=tilt.high)
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
            self._length_s = self.move_time
        elif not self._command(self._servos, goal):
            self._give_up(self._servos)
            return
        self.say.info(_TURNING, pan=goal.pan, tilt=goal.tilt)

    def _command(self, servos: ServoClient, goal: HeadPose) -> bool:
        pan, tilt = self._pan, self._tilt
        pan_us, tilt_us = self._pulses_us or (None, None)
        way_deg = max(pan.way_deg(pan_us, goal.pan), tilt.way_deg(tilt_us, goal.tilt))
        time_ms = turn_ms(way_deg, self.speed)
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
            self._refuse(_NO_HEAD, self._turns[0][0], reason=reason)
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
        self.say.info(_DONE, pan=goal.pan, tilt=goal.tilt)
        self._answer(arrived=True)
        self._begin()

    def _set_pace(self) -> None:
        change_period(self._timer, 1.0 / (self.rate if self._turns else self.rest_rate))

    def _publish(self) -> None:
        message = JointState()
        message.header.stamp = self.get_clock().now().to_msg()
        message.name = list(HEAD_JOINTS)
        if self._pose is not None:
            message.position = [math.radians(self._pose.pan), math.radians(self._pose.tilt)]
        self._publisher.publish(message)


def _joint(values: Mapping[str, Any], name: str) -> HeadJoint:
    """Return the joint that the parameters describe; `name` is pan or tilt."""
    return HeadJoint(
        servo=values[f"{name}_servo"],
        limits=Limits(values[f"{name}_min"], values[f"{name}_max"], "deg"),
        trim_deg=values[f"{name}_trim"],
        reversed=values[f"{name}_reversed"],
        turn_deg=values["servo_turn"],
    )


if __name__ == "__main__":
    raise SystemExit(run(HeadController))
