"""What the Space screen says in its lines."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from space.drawing.camera import Angle
from text.i18n import N_, _, decimal
from text.plain import plain
from tui.space.aim import AimKind
from tui.widgets.scale_bar import scale_bar

if TYPE_CHECKING:
    from collections.abc import Sequence

    from tui.space.aim import Aim
    from tui.space.stage import Stage
    from tui.space.view import SpaceView

ANGLES = {Angle.ABOVE: N_("from above"), Angle.SIDE: N_("from the side"), Angle.PERSPECTIVE: N_("perspective")}
LONGEST = 40


def status(stage: Stage, view: SpaceView) -> list[str]:
    """Return the pieces of the line below the picture, the most important first."""
    fixed = plain(stage.fixed, LONGEST)
    pieces = [
        "".join(ink.text for ink in scale_bar(view.camera.dots_per_m)),
        _("in {frame}").format(frame=fixed) if fixed else _("no frame yet"),
        _(ANGLES[view.camera.angle]),
    ]
    if stage.follow:
        pieces.insert(1, _("follows {frame}").format(frame=plain(stage.follow, LONGEST)))
    if (place := view.pointer_place) is not None:
        x, y, z = (decimal(f"{value:.2f}") for value in place)
        if view.camera.angle is Angle.SIDE:
            pieces.insert(0, _("x {x}  z {z} m").format(x=x, z=z))
        else:
            pieces.insert(0, _("x {x}  y {y} m").format(x=x, y=y))
    return pieces


def armed(aim: Aim, frame: str, listeners: Sequence[str], keys: tuple[str, str]) -> str:
    """Return what is armed, where it is, who would hear it, and what to do."""
    what = _("GOAL") if aim.kind is AimKind.GOAL else _("INITIAL POSE")
    where = place_words(aim, frame)
    heard = ", ".join(listeners) if listeners else _("nobody listens")
    how = _("Press, drag, let go: published. Or arrows, Ctrl+arrows, {enter}. {escape} leaves.").format(
        enter=keys[0], escape=keys[1]
    )
    return f"{what} → {aim.kind.topic} ({heard}) · {where}\n{how}"


def place_words(aim: Aim, frame: str) -> str:
    """Return place and heading."""
    return _("x {x}  y {y} m, heading {degrees}° in {frame}").format(
        x=decimal(f"{aim.x_m:.2f}"),
        y=decimal(f"{aim.y_m:.2f}"),
        degrees=round(math.degrees(aim.heading_rad)),
        frame=plain(frame, LONGEST),
    )


def sent(aim: Aim, frame: str, listeners: int) -> str:
    """Return what was published, and how many heard it."""
    where = place_words(aim, frame)
    if listeners:
        return _("Published on {topic}: {where}.").format(topic=aim.kind.topic, where=where)
    words = _("Published on {topic}, where nobody listens: {where}. Navigation (Nav2) would.")
    return words.format(topic=aim.kind.topic, where=where)


def refusal(*, recorded: bool, engaged: bool, fixed: str) -> str:
    """Return why nothing can be aimed or published now; empty if it can."""
    if recorded:
        return _("This is a recording: there is nobody to send to.")
    if engaged:
        return _("The emergency stop is engaged: release it first, then aim.")
    if not fixed:
        return _("No frame is known yet, in which a place could be given.")
    return ""
