"""The Head panel: where the head looks, as a sight on a field, and what LLM commands told it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from graph.data import GraphUpdate
from robot.joints import HEAD_PAN, HEAD_TILT
from robot.topics import HEAD_STATE, LLM_RESULT
from text.figures import whole
from text.i18n import N_, _
from text.nested import read_json
from text.plain import plain
from tui.panels.panel import Joints, Panel, has_joints, joint_number, trouble_of
from tui.widgets.canvas import Canvas, Point, rectangle
from tui.widgets.drawing import Drawing, Ink, Line, beside, cells_of, fit

LIMIT_DEG = 90.0
SAME_WITHIN_DEG = 0.5
MARK = 8.0
"""Dots on a side of the square around where it is commanded to look."""


@dataclass(frozen=True)
class HeadReading:
    """Angles in degrees; positive is left and up."""

    pan_deg: float
    tilt_deg: float

    @property
    def pan_words(self) -> str:
        return _words(self.pan_deg, _("{degrees}° left"), _("{degrees}° right"))

    @property
    def tilt_words(self) -> str:
        return _words(self.tilt_deg, _("{degrees}° up"), _("{degrees}° down"))

    @property
    def is_known(self) -> bool:
        """Whether both angles are known: servos have none before they are first moved."""
        return math.isfinite(self.pan_deg) and math.isfinite(self.tilt_deg)

    def near(self, other: HeadReading) -> bool:
        """Whether the two are the same except for rounding."""
        pan, tilt = self.pan_deg - other.pan_deg, self.tilt_deg - other.tilt_deg
        return abs(pan) < SAME_WITHIN_DEG and abs(tilt) < SAME_WITHIN_DEG


def _words(degrees: float, plus: str, minus: str) -> str:
    if not math.isfinite(degrees):
        return "---"
    if not round(degrees):
        return "0°"
    return (plus if degrees > 0 else minus).format(degrees=whole(abs(degrees)))


def head_in(value: Mapping[str, Any]) -> HeadReading | None:
    """Read a sensor_msgs/JointState in radians; None if it is not about the head.

    A missing joint is read as nan.
    """
    if not has_joints(value, (HEAD_PAN, HEAD_TILT)):
        return None
    pan, tilt = (math.degrees(joint_number(value, "position", joint)) for joint in (HEAD_PAN, HEAD_TILT))
    return HeadReading(pan, tilt)


DRAWN_FROM = (22, 6)
"""Columns and lines from which on the field is drawn."""


class HeadView(Drawing):
    """Shows a `HeadReading`, the last commanded pose, and the service's answer."""

    def __init__(self) -> None:
        super().__init__()
        self._pose: HeadReading | None = None
        self._told: HeadReading | None = None
        self._answer = ""
        self._moving = False

    def show(self, pose: HeadReading) -> None:
        before = self._pose if self._pose is not None and self._pose.is_known else None
        moving = before is not None and pose.is_known and not before.near(pose)
        if (pose, moving) != (self._pose, self._moving):
            self._pose, self._moving = pose, moving
            self.redraw()

    def command(self, told: HeadReading) -> None:
        """Mark where the head is commanded to look; the answer is still unknown."""
        self._told, self._answer = told, ""
        self.redraw()

    def answer(self, words: str) -> None:
        self._answer = plain(words, 200)
        self.redraw()

    @property
    def has_value(self) -> bool:
        return self._pose is not None

    def draw(self, width: int, height: int) -> list[Line]:
        pose = self._pose
        if pose is None:
            return []
        state = self._state()
        numbers: Line = [
            Ink(_("pan") + " ", "muted"),
            Ink(pose.pan_words, "accent"),
            Ink("  " + _("tilt") + " ", "muted"),
            Ink(pose.tilt_words, "second"),
        ]
        words = self._in_words(numbers, state, width)
        if width < DRAWN_FROM[0] or height < DRAWN_FROM[1]:
            return words
        return [*_field(pose, self._told, width, max(0, height - len(words))), *words]

    def _in_words(self, numbers: Line, state: Line, width: int) -> list[Line]:
        told = self._told_lines(width)
        if cells_of(numbers) + cells_of(state) < width:
            return [beside(numbers, state, width), *told]
        if cells_of(numbers) <= width:
            return [numbers, beside([], state, width), *told]
        second = [Ink(numbers[2].text.lstrip(), "muted"), numbers[3]]
        return [numbers[:2], second, state, *told]

    def _state(self) -> Line:
        if self.stale:
            return [Ink(self.stale_words, "alert")]
        if self._pose is not None and not self._pose.is_known:
            return [Ink(_("unknown until it turns"), "muted")]
        return [Ink(_("moving"), "warn") if self._moving else Ink(_("at rest"), "muted")]

    def _told_lines(self, width: int) -> list[Line]:
        told = self._told
        lines: list[Line] = []
        if told is not None:
            words = _("commanded: {pan}, {tilt}").format(pan=told.pan_words, tilt=told.tilt_words)
            lines.append([Ink(f"╱ {words}", "muted")])
        if self._answer:
            lines.append([Ink(self._answer, "muted")])
        if len(lines) == 2 and cells_of(lines[0]) + cells_of(lines[1]) < width:
            return [beside(lines[0], lines[1], width)]
        return [[Ink(fit(line[0].text, width), "muted")] for line in lines]


def _field(pose: HeadReading, told: HeadReading | None, columns: int, rows: int) -> list[Line]:
    """Draw all that the head can turn to, straight ahead in the middle, and a cross where it looks."""
    dots = Canvas(columns, rows)
    reach = min(dots.width, dots.height) / 2 - 1
    middle, centre = dots.width / 2, dots.height / 2
    left, right, top, bottom = middle - reach, middle + reach, centre - reach, centre + reach

    def at(pan_deg: float, tilt_deg: float) -> Point:
        across, up = (max(-1.0, min(1.0, degrees / LIMIT_DEG)) for degrees in (pan_deg, tilt_deg))
        return middle - reach * across, centre - reach * up

    dots.outline([(left, top), (right, top), (right, bottom), (left, bottom)], "muted")
    for step in (0.0, math.pi / 2):
        end = reach * math.cos(step), reach * math.sin(step)
        dots.line((middle - end[0], centre - end[1]), (middle + end[0], centre + end[1]), "muted", dash=(1, 3))
    if told is not None and told.is_known:
        dots.outline(rectangle(at(told.pan_deg, told.tilt_deg), MARK, MARK, 0.0), "strong")
    if pose.is_known:
        x, y = at(pose.pan_deg, pose.tilt_deg)
        dots.line((x, top), (x, bottom), "accent")
        dots.line((left, y), (right, y), "second")
        dots.fill(rectangle((x, y), MARK / 2, MARK / 2, 0.0), "strong")
    return dots.lines()


class HeadPanel(Panel):
    """Pan and tilt."""

    view = HeadView
    title = N_("Head")
    least = 3
    weight = 4

    def __init__(self) -> None:
        super().__init__()
        self._joints = Joints(HEAD_STATE, (HEAD_PAN, HEAD_TILT))

    def watched(self) -> set[str]:
        return {HEAD_STATE}

    def followed(self) -> set[str]:
        return {LLM_RESULT}

    def show(self, update: GraphUpdate) -> None:
        drawing = self.query_one(HeadView)
        for sample in update.samples.get(HEAD_STATE, ()):
            pose = head_in(sample.value)
            if pose is not None:
                drawing.show(pose)
            self._joints.hear(sample, read=pose is not None)
        drawing.show_placeholder(self._joints.placeholder)
        for sample in update.samples.get(LLM_RESULT, ()):
            self._hear(str(sample.value.get("data", "")))
        drawing.show_trouble(*trouble_of(update, HEAD_STATE))

    def _hear(self, text: str) -> None:
        try:
            said: Any = read_json(text)
            if said["event"] == "head":
                drawing = self.query_one(HeadView)
                drawing.command(HeadReading(float(said["pan"]), float(said["tilt"])))
                if "error" in said:
                    drawing.answer(str(said["error"]))
                else:
                    drawing.answer(_("done") if said.get("sum") == 1 else _("refused"))
        except (ValueError, KeyError, TypeError, OverflowError):
            # Anybody may publish there; messages in another format are ignored.
            return
