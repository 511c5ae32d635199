"""The legend of the map: what its signs mean, and how long a metre is on it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

from text.figures import figure
from text.i18n import _, decimal
from text.plain import plain
from tui.panels.map.scene import (
    BLIND_SIGN,
    FREE_SIGN,
    FRONT,
    GOAL,
    GOAL_SIGN,
    HIT_SIGN,
    PATH,
    ROBOT,
    TRUTH,
    grid_step_m,
)
from tui.panels.sonar.bar import ink_of
from tui.panels.sonar.words import remark
from tui.widgets.drawing import Ink, Line, beside, cells_of, fit
from tui.widgets.scale_bar import scale_bar

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robot.motion.odometry import Pose
    from tui.panels.map.scene import Scene
    from tui.panels.map.viewport import Viewport
    from tui.panels.sonar.words import Bounds

GAP = "  "


class LegendEntry(NamedTuple):
    """One line of the legend; where there is little room, those with a high rank are left out."""

    rank: int
    line: Line


def entries(scene: Scene, view: Viewport, driven_m: float, remarks: Sequence[str]) -> list[LegendEntry]:
    """All entries in reading order; `remarks` are warnings."""
    said = [LegendEntry(0, [Ink(plain(words, 200), "alert")]) for words in remarks if words]
    said += _robot(scene.pose)
    if driven_m >= 0.05:
        words = _("path {metres} m").format(metres=figure(driven_m, 1))
        said.append(LegendEntry(7, [Ink("─ ", PATH), Ink(words)]))
    if scene.goal is not None:
        metres = scene.pose.distance_to(scene.goal)
        words = _("goal {metres} m away").format(metres=figure(metres, 1))
        said.append(LegendEntry(3, [Ink(f"{GOAL_SIGN} ", GOAL), Ink(words)]))
    said += [LegendEntry(4, _ray(place, metres, scene.bounds)) for place, metres in scene.rays.items()]
    if scene.truth is not None:
        metres = scene.pose.distance_to(scene.truth)
        words = _("true pose, {metres} m off").format(metres=decimal(f"{metres:.2f}"))
        said.append(LegendEntry(5, [Ink("◇ ", TRUTH), Ink(words)]))
    said.append(LegendEntry(2, scale_bar(view.dots_per_m)))
    said.append(LegendEntry(8, [Ink(_("x → right, y ↑ up"), "muted")]))
    words = _("· every {metres} m").format(metres=decimal(f"{grid_step_m(view):g}"))
    said.append(LegendEntry(9, [Ink(words, "muted")]))
    return said


def _robot(pose: Pose) -> list[LegendEntry]:
    place = _("x {x}  y {y} m").format(x=decimal(f"{pose.x_m:.2f}"), y=decimal(f"{pose.y_m:.2f}"))
    degrees = round(math.degrees(pose.heading_rad))
    heading = _("heading {degrees}°").format(degrees=degrees)
    return [LegendEntry(1, [Ink("▲ ", ROBOT), Ink(place, "strong")]), LegendEntry(6, [Ink("  "), Ink(heading)])]


def _ray(place: str, metres: float, bounds: Bounds) -> Line:
    name = _("front") if place == FRONT else _("rear")
    words = remark(metres) or _("{metres} m").format(metres=figure(metres, 1))
    sign = BLIND_SIGN if math.isnan(metres) else FREE_SIGN if metres == math.inf else HIT_SIGN
    return [Ink(f"{sign} ", ink_of(metres, bounds)), Ink(f"{name} {words}")]


def column(said: Sequence[LegendEntry], width: int, height: int) -> list[Line]:
    """The entries below each other in exactly this space; the least important are left out."""
    lines = [beside(entry.line, [], width) for entry in _foremost(said, height)]
    return [*lines, *([[Ink(" " * width)]] * (height - len(lines)))]


def rows(said: Sequence[LegendEntry], width: int, height: int) -> list[Line]:
    """The entries side by side in at most `height` lines; the least important are left out."""
    for count in range(len(said), 0, -1):
        lines = _packed(_foremost(said, count), width)
        if len(lines) <= height:
            return lines
    line = min(said, key=lambda entry: entry.rank).line if said else []
    return [beside(line, [], width)] if line else []


def _foremost(said: Sequence[LegendEntry], count: int) -> list[LegendEntry]:
    """The `count` most important entries, in reading order."""
    kept = sorted(range(len(said)), key=lambda at: (said[at].rank, at))[:count]
    return [said[at] for at in sorted(kept)]


def _packed(said: Sequence[LegendEntry], width: int) -> list[Line]:
    lines: list[Line] = []
    for entry in said:
        line = [Ink(entry.line[0].text.lstrip(), entry.line[0].look), *entry.line[1:]]
        if lines and cells_of(lines[-1]) + len(GAP) + cells_of(line) <= width:
            lines[-1] = [*lines[-1], Ink(GAP), *line]
        elif cells_of(line) <= width:
            lines.append(line)
        else:
            lines.append([Ink(fit("".join(ink.text for ink in line), width), line[-1].look)])
    return lines
