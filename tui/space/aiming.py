"""A goal or an initial pose that is about to be published: where, with what heading, in words."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

from space.drawing.paints import Tint
from space.drawing.shapes import Shape, Strokes, arrow, places
from space.transform import Transform, quaternion_from_rpy
from text.i18n import _, decimal
from text.plain import plain
from text.ros_names import GOAL_POSE, INITIAL_POSE

if TYPE_CHECKING:
    from graph.data import Value

LONGEST = 40
COVARIANCE = {0: 0.25, 7: 0.25, 35: (math.pi / 12) ** 2}
"""What RViz sends: half a metre and 15 degrees, as variances in a 6x6 matrix."""
ARROW_DOTS, CROSS_DOTS = 26.0, 7.0
HEADING_STEP_RAD = math.radians(15)


class AimKind(NamedTuple):
    """What can be aimed."""

    topic: str
    type_name: str


GOAL = AimKind(GOAL_POSE, "geometry_msgs/msg/PoseStamped")
INITIAL = AimKind(INITIAL_POSE, "geometry_msgs/msg/PoseWithCovarianceStamped")


@dataclass(frozen=True)
class Aim:
    """Something to be published, in the fixed frame."""

    kind: AimKind
    x_m: float
    y_m: float
    heading_rad: float = 0.0

    def shifted(self, right_m: float, up_m: float) -> Aim:
        return replace(self, x_m=self.x_m + right_m, y_m=self.y_m + up_m)

    def turned(self, steps: int) -> Aim:
        heading = math.remainder(self.heading_rad + steps * HEADING_STEP_RAD, math.tau)
        return replace(self, heading_rad=heading)

    def towards(self, x_m: float, y_m: float) -> Aim:
        return replace(self, heading_rad=math.atan2(y_m - self.y_m, x_m - self.x_m))

    def shapes(self, dots_per_m: float) -> list[Shape]:
        """Return an arrow with a cross-hair, of a size that is seen whatever the scale."""
        at = Transform.from_rpy((self.x_m, self.y_m, 0.0), (0.0, 0.0, self.heading_rad))
        arm = CROSS_DOTS / dots_per_m
        x, y = self.x_m, self.y_m
        cross = Strokes(
            places((x - arm, y, 0.0), (x, y - arm, 0.0)), places((x + arm, y, 0.0), (x, y + arm, 0.0)), Tint.WARN
        )
        return [cross, arrow(at, ARROW_DOTS / dots_per_m, Tint.WARN)]

    def message(self, frame: str) -> Mapping[str, Value]:
        """Return the message, with the stamp 0: the newest transform is meant, by any clock."""
        x, y, z, w = quaternion_from_rpy(0.0, 0.0, self.heading_rad)
        pose: dict[str, Value] = {
            "position": {"x": self.x_m, "y": self.y_m, "z": 0.0},
            "orientation": {"x": x, "y": y, "z": z, "w": w},
        }
        header: dict[str, Value] = {"stamp": {"sec": 0, "nanosec": 0}, "frame_id": frame}
        if self.kind is GOAL:
            return {"header": header, "pose": pose}
        covariance = [COVARIANCE.get(place, 0.0) for place in range(36)]
        return {"header": header, "pose": {"pose": pose, "covariance": covariance}}


def armed_words(aim: Aim, frame: str, listeners: Sequence[str], keys: tuple[str, str]) -> str:
    what = _("GOAL") if aim.kind is GOAL else _("INITIAL POSE")
    where = place_words(aim, frame)
    heard = ", ".join(listeners) if listeners else _("nobody listens")
    how = _("Press, drag, let go: published. Or arrows, Ctrl+arrows, {enter}. {escape} leaves.").format(
        enter=keys[0], escape=keys[1]
    )
    return f"{what} → {aim.kind.topic} ({heard}) · {where}\n{how}"


def place_words(aim: Aim, frame: str) -> str:
    return _("x {x}  y {y} m, heading {degrees}° in {frame}").format(
        x=decimal(f"{aim.x_m:.2f}"),
        y=decimal(f"{aim.y_m:.2f}"),
        degrees=round(math.degrees(aim.heading_rad)),
        frame=plain(frame, LONGEST),
    )


def sent_words(aim: Aim, frame: str, listeners: int) -> str:
    where = place_words(aim, frame)
    if listeners:
        return _("Published on {topic}: {where}.").format(topic=aim.kind.topic, where=where)
    words = _("Published on {topic}, where nobody listens: {where}. Navigation (Nav2) would.")
    return words.format(topic=aim.kind.topic, where=where)
