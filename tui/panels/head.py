"""The Head panel: where the head looks, from above and from the side, and what LLM commands told it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from graph.data import GraphUpdate
from robot.joints import HEAD_PAN, HEAD_TILT
from robot.topics import HEAD_STATE, LLM_RESULT
from text.figures import whole
from text.i18n import N_, _
from text.nested import read_json
from text.plain import plain
from tui.panels.panel import Joints, Panel, has_joints, joint_number, trouble_of
from tui.widgets.canvas import Canvas, Point
from tui.widgets.drawing import Drawing, Ink, Line, beside, cells_of, fit

LIMIT_DEG = 90.0
SAME_WITHIN_DEG = 0.5


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


CAPTION_FROM = 10
DRAWN_FROM = (22, 6)


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
        titles = [Ink(fit(title, width // 2), "muted") for title in (_("from above"), _("from right"))]
        caption = [titles] if height >= CAPTION_FROM else []
        rows = max(0, height - len(words) - len(caption))
        return [*caption, *self._views(pose, width, rows), *words]

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

    def _views(self, pose: HeadReading, width: int, rows: int) -> list[Line]:
        columns = (width - 2) // 2
        above, side = Canvas(columns, rows), Canvas(columns, rows)
        radius = min(above.width / 2, above.height / 2) - 2
        told = self._told
        dial = Dial(above, (above.width / 2, (above.height + radius) / 2), radius, 90.0)
        dial.draw(pose.pan_deg, None if told is None else told.pan_deg, "accent")
        dial = Dial(side, ((side.width - radius) / 2, side.height / 2), radius, 0.0)
        dial.draw(pose.tilt_deg, None if told is None else told.tilt_deg, "second")
        gap = Ink(" " * (width - 2 * columns))
        return [[*one, gap, *other] for one, other in zip(above.lines(), side.lines(), strict=True)]


class Dial(NamedTuple):
    """Half a circle of dots around a centre; `zero_deg` is the direction of 0, 90 is upwards."""

    dots: Canvas
    centre: Point
    radius: float
    zero_deg: float

    def draw(self, degrees: float, told_deg: float | None, look: str) -> None:
        x, y = np.transpose([self._at(step, 1.0) for step in range(-90, 91, 15)])
        self.dots.dots(x, y, "muted")
        if told_deg is not None and math.isfinite(told_deg):
            self.dots.line(self._at(told_deg, 0.75), self._at(told_deg, 1.1), "strong")
        if math.isfinite(degrees):
            shown = max(-LIMIT_DEG, min(LIMIT_DEG, degrees))
            self.dots.line(self._at(shown, 0.0), self._at(shown, 0.95), look)
            for turn in (-20.0, 20.0):
                self.dots.line(self._at(shown, 0.95), self._at(shown + turn, 0.7), look)

    def _at(self, degrees: float, share: float) -> Point:
        angle = math.radians(self.zero_deg + degrees)
        reach = self.radius * share
        return self.centre[0] + reach * math.cos(angle), self.centre[1] - reach * math.sin(angle)


class HeadPanel(Panel):
    """Pan and tilt, from above and from the side."""

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
