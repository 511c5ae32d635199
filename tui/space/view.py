"""The picture of space: it holds the camera, and what mouse and keys do to it."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, ClassVar, NamedTuple, cast

import numpy as np
from rich.color import Color
from rich.segment import Segment
from rich.style import Style
from textual.binding import Binding, BindingType
from textual.events import MouseDown, MouseMove, MouseScrollDown, MouseScrollUp, MouseUp, Resize
from textual.geometry import Region
from textual.message import Message
from textual.strip import Strip
from textual.timer import Timer
from textual.widget import Widget

from space.drawing.paints import Tint, rgb_of
from space.drawing.picture import CellPicture, SpaceBox, SpaceCamera
from tui.terminal.bandwidth import HasBandwidth
from tui.widgets.canvas import spans
from tui.widgets.words import OneStyle, word_strips

if TYPE_CHECKING:
    from tui.space.aiming import Aim

PAINTED = ("text", "muted", "accent", "second", "good", "warn", "bad", "free", "wall", "maybe")
ZOOM = 1.25
PAN_CELLS = 4
LEAST_DRAG_DOTS = 6.0
"""A shorter way of the mouse is a click, and gives no heading."""


class _Drag(NamedTuple):
    x: float
    y: float
    begun: tuple[float, float]
    aims: bool


class SpaceView(OneStyle, Widget, can_focus=True):
    """Shows a picture that `compose_picture` makes for a camera and a size in cells."""

    class CameraMoved(Message):
        """The user has moved the camera."""

    class PointerMoved(Message):
        """The mouse is over another place."""

    class Aimed(Message):
        """What is aimed was moved; `done` if the mouse was let go after a drag."""

        def __init__(self, *, done: bool) -> None:
            super().__init__()
            self.done = done

    ALLOW_SELECT = False
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("left", "pan(-1, 0)", show=False),
        Binding("right", "pan(1, 0)", show=False),
        Binding("up", "pan(0, -1)", show=False),
        Binding("down", "pan(0, 1)", show=False),
        Binding("ctrl+left", "turn(1)", show=False),
        Binding("ctrl+right", "turn(-1)", show=False),
        Binding("plus,equals_sign", "closer(1)", show=False),
        Binding("minus,underscore", "closer(-1)", show=False),
        Binding("pageup", "zoom(1)", show=False),
        Binding("pagedown", "zoom(-1)", show=False),
    ]
    COMPONENT_CLASSES: ClassVar[set[str]] = {f"space--{name}" for name in PAINTED}
    DEFAULT_CSS = """
    SpaceView {
        width: 1fr; height: 1fr; min-height: 3;
        .space--text { color: $foreground; }
        .space--muted { color: $foreground 35%; }
        .space--accent { color: $text-accent; }
        .space--second { color: $text-primary; text-style: bold; }
        .space--good { color: $text-success; text-style: bold; }
        .space--warn { color: $text-warning; text-style: bold; }
        .space--bad { color: $text-error; }
        .space--free { color: $foreground 12%; }
        .space--wall { color: $foreground 80%; }
        .space--maybe { color: $foreground 40%; }
    }
    """

    def __init__(self, compose_picture: Callable[[SpaceCamera, int, int], CellPicture]) -> None:
        super().__init__()
        self.camera = SpaceCamera()
        self.aim: Aim | None = None
        """What is aimed; None while nothing is armed."""
        self.fits = True
        """Whether the camera shows everything, until the user moves it."""
        self.recorded = False
        """Whether a recording is played, which has the keys + and - for its speed."""
        self._make_picture = compose_picture
        self._picture: CellPicture | None = None
        self._words = ("", "")
        self._fitted: SpaceBox | None = None
        self._drag: _Drag | None = None
        self._pointer: tuple[float, float] | None = None
        self._timer: Timer | None = None
        self._styles: dict[tuple[int, int], Style] = {}
        self._colours: dict[int, Color | None] = {}
        self._theme: object = None

    # The picture

    @property
    def dots(self) -> tuple[int, int]:
        return 2 * self.size.width, 4 * self.size.height

    @property
    def pointer_place(self) -> tuple[float, float] | None:
        return None if self._pointer is None else self.camera.floor_at(*self._pointer, *self.dots)

    def show_words(self, headline: str, detail: str = "") -> None:
        """Show why there is nothing to see, in place of the picture; empty to show it again."""
        if (headline, detail) != self._words:
            self._words = headline, detail
            self.refresh()

    def fit(self, box: SpaceBox | None, *, anew: bool = False) -> None:
        """Show all of a box, if the camera is to show everything and does not do so already."""
        if anew:
            self.fits, self._fitted = True, None
        width, height = self.dots
        if not self.fits or box is None or not width or not height:
            return
        if self._fitted is None or not self._fitted.holds(box):
            self._fitted = box if self._fitted is None else box.widened(0.08, 0.0)
            box = self._fitted
            self.camera = self.camera.fitting(box, width, height)

    def renew(self, *, by_user: bool = False) -> None:
        """Draw the picture anew; one that the user has not asked for waits for the terminal."""
        if not self.is_mounted or not self.size.width or not self.size.height:
            return
        if not by_user and (wait_s := cast("HasBandwidth", self.app).bandwidth.wait_s()):
            if self._timer is None:
                self._timer = self.set_timer(wait_s, self._look_again)
            return
        had, now = self._picture, self._make_picture(self.camera, *self.size)
        if had is None or had.codes.shape != now.codes.shape:
            self._picture = now
            self.refresh()
            return
        self._picture = now
        regions = [Region(column, row, cells, 1) for row, column, cells in spans(now.changed(had))]
        if not self._words[0] and regions:
            self.refresh(*regions)

    def _look_again(self) -> None:
        self._timer = None
        self.renew()

    def on_resize(self, event: Resize) -> None:
        del event
        self._fitted = None
        self.post_message(self.CameraMoved())

    def on_language_changed(self) -> None:
        self._theme = None
        self.refresh()

    def render_line(self, y: int) -> Strip:
        width, base = self.size.width, self.rich_style
        if self._words[0]:
            strips = word_strips(self._words, width, base, self.app.console, centred=True)
            line = y - max(0, (self.size.height - len(strips)) // 2)
            return strips[line] if 0 <= line < len(strips) else Strip.blank(width, base)
        picture = self._picture
        if picture is None or y >= len(picture.codes) or picture.codes.shape[1] != width:
            return Strip.blank(width, base)
        self._check_theme()
        looks = picture.front[y].astype(np.uint16) << 8 | picture.back[y]
        text = picture.codes[y].astype("<u2").tobytes().decode("utf-16-le", "replace")
        starts = [0, *(np.flatnonzero(np.diff(looks)) + 1).tolist()]
        ends = (*starts[1:], len(text))
        segments = [
            Segment(text[start:end], self._style(int(looks[start]) >> 8, int(looks[start]) & 255))
            for start, end in zip(starts, ends, strict=True)
        ]
        return Strip(segments, width)

    def _check_theme(self) -> None:
        theme = (self.app.theme, self.rich_style.bgcolor)
        if theme != self._theme:
            self._theme = theme
            self._styles.clear()
            self._colours.clear()

    def _style(self, front: int, back: int) -> Style:
        style = self._styles.get((front, back))
        if style is None:
            style = self.rich_style + Style.from_color(
                self._colour(front) if front else None, self._colour(back) if back else None
            )
            if front in {Tint.SECOND, Tint.GOOD, Tint.WARN}:
                style += Style(bold=True)
            self._styles[front, back] = style
        return style

    def _colour(self, paint: int) -> Color | None:
        if paint not in self._colours:
            rgb = rgb_of(paint)
            if rgb is None:
                name = f"space--{Tint(paint).name.lower()}"
                self._colours[paint] = self.get_component_rich_style(name).color
            else:
                self._colours[paint] = Color.from_rgb(*rgb)
        return self._colours[paint]

    # Keys

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        """Leave + and - to a recording, which has its speed on them."""
        del parameters
        return not (action == "closer" and self.recorded)

    def action_pan(self, right: int, down: int) -> None:
        """Move what is seen by some cells, or what is aimed by one."""
        if self.aim is None:
            step_x, step_y = right * PAN_CELLS * 2, down * PAN_CELLS * 4
            self._move(self.camera.panned(-step_x, -step_y))
            return
        metres = 2 / self.camera.dots_per_m
        self.aim = self.aim.shifted(right * metres, -down * metres)
        self.post_message(self.Aimed(done=False))

    def action_turn(self, left: int) -> None:
        if self.aim is not None:
            self.aim = self.aim.turned(left)
            self.post_message(self.Aimed(done=False))

    def action_closer(self, steps: int) -> None:
        self._move(self.camera.zoomed(ZOOM**steps))

    def action_zoom(self, steps: int) -> None:
        self._move(self.camera.zoomed(ZOOM**steps))

    def _move(self, camera: SpaceCamera) -> None:
        self.camera, self.fits = camera, False
        self.post_message(self.CameraMoved())

    # Mouse

    def on_mouse_scroll_up(self, event: MouseScrollUp) -> None:
        event.stop()
        self._zoom_about(ZOOM, event.x, event.y)

    def on_mouse_scroll_down(self, event: MouseScrollDown) -> None:
        event.stop()
        self._zoom_about(1 / ZOOM, event.x, event.y)

    def _zoom_about(self, factor: float, x: float, y: float) -> None:
        width, height = self.dots
        spot = _middle_of(x, y)
        self._move(self.camera.zoomed(factor, spot[0] - width / 2, spot[1] - height / 2))

    def on_mouse_down(self, event: MouseDown) -> None:
        self.focus()
        spot = _middle_of(event.x, event.y)
        if self.aim is not None:
            x_m, y_m = self.camera.floor_at(*spot, *self.dots)
            self.aim = self.aim.shifted(x_m - self.aim.x_m, y_m - self.aim.y_m)
            self.post_message(self.Aimed(done=False))
        self._drag = _Drag(*spot, spot, aims=self.aim is not None)
        self.capture_mouse()

    def on_mouse_move(self, event: MouseMove) -> None:
        spot = _middle_of(event.x, event.y)
        drag = self._drag
        if spot != self._pointer:
            self._pointer = spot
            self.post_message(self.PointerMoved())
        if drag is None:
            return
        right, down = spot[0] - drag.x, spot[1] - drag.y
        if not right and not down:
            return
        self._drag = drag._replace(x=spot[0], y=spot[1])
        if drag.aims:
            if self.aim is not None and math.dist(spot, drag.begun) > 0:
                self.aim = self.aim.towards(*self.camera.floor_at(*spot, *self.dots))
                self.post_message(self.Aimed(done=False))
        else:
            self._move(self.camera.panned(right, down))

    def on_mouse_up(self, event: MouseUp) -> None:
        """End the drag; one that was long enough to give a heading ends the aiming as well."""
        drag, self._drag = self._drag, None
        self.release_mouse()
        if drag is None or not drag.aims or self.aim is None:
            return
        if math.dist(_middle_of(event.x, event.y), drag.begun) >= LEAST_DRAG_DOTS:
            self.post_message(self.Aimed(done=True))

    def on_leave(self) -> None:
        self._pointer = None
        self.post_message(self.PointerMoved())


def _middle_of(x: float, y: float) -> tuple[float, float]:
    return 2 * math.floor(x) + 1.0, 4 * math.floor(y) + 2.0
