"""What the simulated camera shows: a small film, or the room around the simulated robot.

Drawn with numpy alone, directly into the bytes of the message: a picture takes well under a
millisecond, and loading OpenCV just for letters would cost more memory than the whole node.
"""

from __future__ import annotations

import math
import time

import numpy as np
from geometry_msgs.msg import PoseStamped
from numpy.typing import NDArray
from sensor_msgs.msg import JointState

from nodes.parts.node import DEPTH, LessonNode
from robot.joints import HEAD_PAN, HEAD_TILT
from robot.motion.odometry import Pose, yaw_from_quaternion
from robot.topics import HEAD_STATE, MOCK_POSE
from robot.world.view import CameraPose, RoomView
from robot.world.world import LIVING_ROOM
from text.i18n import N_

_SKY_TOP, _SKY_LOW = (96, 148, 224), (196, 220, 244)
_GROUND_FAR, _GROUND_NEAR = (132, 148, 96), (72, 88, 56)
_BALL, _BALL_LIGHT = (216, 72, 40), (255, 188, 160)
_CAPTION, _BAND = (24, 255, 64), (24, 32, 48)

_GLYPH_ROWS = 7
_GLYPHS = {
    " ": "00000 00000 00000 00000 00000 00000 00000",
    ":": "00000 00100 00000 00000 00000 00100 00000",
    "F": "11111 10000 10000 11110 10000 10000 10000",
    "S": "01111 10000 10000 01110 00001 00001 11110",
    "V": "10001 10001 10001 10001 10001 01010 00100",
    "a": "00000 00000 01110 00001 01111 10001 01111",
    "d": "00001 00001 01101 10011 10001 10001 01111",
    "e": "00000 00000 01110 10001 11111 10000 01110",
    "i": "00100 00000 01100 00100 00100 00100 01110",
    "l": "01100 00100 00100 00100 00100 00100 01110",
    "m": "00000 00000 11010 10101 10101 10101 10101",
    "n": "00000 00000 10110 11001 10001 10001 10001",
    "o": "00000 00000 01110 10001 10001 10001 01110",
    "r": "00000 00000 10110 11001 10000 10000 10000",
    "s": "00000 00000 01111 10000 01110 00001 11110",
    "t": "01000 01000 11110 01000 01000 01001 00110",
    "u": "00000 00000 10001 10001 10001 10011 01101",
    "0": "01110 10001 10011 10101 11001 10001 01110",
    "1": "00100 01100 00100 00100 00100 00100 01110",
    "2": "01110 10001 00001 00110 01000 10000 11111",
    "3": "11111 00010 00100 00010 00001 10001 01110",
    "4": "00010 00110 01010 10010 11111 00010 00010",
    "5": "11111 10000 11110 00001 00001 10001 01110",
    "6": "00110 01000 10000 11110 10001 10001 01110",
    "7": "11111 00001 00010 00100 01000 01000 01000",
    "8": "01110 10001 10001 01110 10001 10001 01110",
    "9": "01110 10001 10001 01111 00001 00010 01100",
}


class MovingScene:
    """Draws the n-th picture of the film; the same n gives the same picture."""

    def __init__(self, height: int, width: int, *, blue_first: bool) -> None:
        self._order = slice(None, None, -1) if blue_first else slice(None)
        self._height, self._width = height, width
        self._scale = max(1, width // 210)
        self._background = self._paint_background()
        self._radius = max(2, height // 8)
        self._ball, self._ball_mask = self._paint_ball()
        self._letters = {letter: self._paint_letter(rows) for letter, rows in _GLYPHS.items()}

    def draw(self, picture: NDArray[np.uint8], number: int) -> None:
        """Draw picture `number` into an array of shape (height, width, 3)."""
        picture[:] = self._background
        self._draw_ball(picture, number)
        self._draw_caption(picture, f"Simulated Vision: Frame {number}")

    def _paint_background(self) -> NDArray[np.uint8]:
        horizon = self._height * 3 // 5
        rows = np.concatenate(
            (np.linspace(_SKY_TOP, _SKY_LOW, horizon), np.linspace(_GROUND_FAR, _GROUND_NEAR, self._height - horizon))
        )
        # A dark band, to make the caption readable.
        rows[self._height // 12 - 2 * self._scale :][: (_GLYPH_ROWS + 4) * self._scale] = _BAND
        colours = rows.astype(np.uint8)[:, self._order]
        return np.repeat(colours[:, None, :], self._width, axis=1)

    def _paint_ball(self) -> tuple[NDArray[np.uint8], NDArray[np.bool_]]:
        radius = self._radius
        y, x = np.mgrid[-radius : radius + 1, -radius : radius + 1] / radius
        mask = x**2 + y**2 <= 1.0
        light = np.clip(1.0 - np.hypot(x + 0.4, y + 0.4), 0.0, 1.0)[:, :, None]
        colours = np.array(_BALL) + (np.array(_BALL_LIGHT) - np.array(_BALL)) * light
        return colours.astype(np.uint8)[:, :, self._order], mask

    def _paint_letter(self, rows: str) -> NDArray[np.bool_]:
        small = np.array([[bit == "1" for bit in row] for row in rows.split()])
        return small.repeat(self._scale, axis=0).repeat(self._scale, axis=1)

    def _draw_ball(self, picture: NDArray[np.uint8], number: int) -> None:
        size = 2 * self._radius + 1
        ways = self._width - size, self._height - size
        if min(ways) < 1:
            return
        left = round(ways[0] * (0.5 - 0.5 * math.cos(number * 0.05)))
        top = round(ways[1] * (1.0 - abs(math.sin(number * 0.17)) * 0.8))
        spot = picture[top : top + size, left : left + size]
        spot[self._ball_mask] = self._ball[self._ball_mask]

    def _draw_caption(self, picture: NDArray[np.uint8], caption: str) -> None:
        height, step = _GLYPH_ROWS * self._scale, 6 * self._scale
        top, left = self._height // 12, self._width // 24
        colour = np.array(_CAPTION, np.uint8)[self._order]
        for letter in caption:
            mask = self._letters[letter]
            spot = picture[top : top + height, left : left + mask.shape[1]]
            spot[mask[: spot.shape[0], : spot.shape[1]]] = colour
            left += step


_PATIENCE_S = 3.0
_NO_POSE = N_("Nobody publishes {topic}: the picture is that of the start (is mock_robot running?)")


class RoomScene:
    """Follows the true pose of the robot, and the head that the camera sits on."""

    def __init__(self, node: LessonNode, height: int, width: int, *, blue_first: bool) -> None:
        self._say = node.say
        self._view = RoomView(LIVING_ROOM, height, width, blue_first=blue_first)
        self._pose, self._pan_rad, self._tilt_rad = Pose(), 0.0, 0.0
        self._drawn: CameraPose | None = None
        self._waits_since_s: float | None = time.monotonic()
        node.create_subscription(PoseStamped, MOCK_POSE, self._take_pose, DEPTH)
        node.create_subscription(JointState, HEAD_STATE, self._take_head, DEPTH)

    def draw(self, picture: NDArray[np.uint8], _number: int) -> None:
        """Draw into an array of shape (height, width, 3), always the same one."""
        since_s = self._waits_since_s
        if since_s is not None and time.monotonic() - since_s > _PATIENCE_S:
            self._say.warn(_NO_POSE, every_s=30.0, topic=MOCK_POSE)
        eye = CameraPose.on(self._pose, self._pan_rad, self._tilt_rad)
        if eye != self._drawn:
            # A standing robot keeps its picture.
            self._view.draw(picture, eye)
            self._drawn = eye

    def _take_pose(self, message: PoseStamped) -> None:
        place, turn = message.pose.position, message.pose.orientation
        pose = Pose(place.x, place.y, yaw_from_quaternion(turn.x, turn.y, turn.z, turn.w))
        if pose.is_finite:
            self._pose, self._waits_since_s = pose, None

    def _take_head(self, message: JointState) -> None:
        angles = dict(zip(message.name, message.position, strict=False))
        # A head with an unknown direction counts as looking straight ahead.
        looks = angles.get(HEAD_PAN, 0.0), angles.get(HEAD_TILT, 0.0)
        if all(map(math.isfinite, looks)):
            self._pan_rad, self._tilt_rad = looks
