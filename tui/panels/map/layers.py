"""What stays the same between frames: grid, room and path are drawn once, then only additions."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tui.panels.map.canvas import Canvas
from tui.panels.map.scene import draw_grid, draw_occupancy, draw_path, grid_step_m

if TYPE_CHECKING:
    from tui.panels.map.driven_path import DrivenPath
    from tui.panels.map.reading import OccupancyGrid
    from tui.panels.map.viewport import Viewport


class Layers:
    """The canvas below everything that moves."""

    def __init__(self) -> None:
        self._canvas = Canvas(1, 1)
        self._drawn: tuple[Viewport, OccupancyGrid | None, DrivenPath, int] | None = None
        self._done = (0, 0)
        """Number of pieces of the path that have been drawn, and of points in the last of them."""

    def canvas(self, view: Viewport, occupancy: OccupancyGrid | None, trail: DrivenPath) -> Canvas:
        """Return a copy with grid, room and path, to draw the rest on."""
        wanted = (view, occupancy, trail, trail.revision)
        if wanted != self._drawn:
            self._drawn, self._done = wanted, (0, 0)
            self._canvas = Canvas(view.columns, view.rows)
            draw_grid(self._canvas, view, grid_step_m(view))
            if occupancy is not None:
                draw_occupancy(self._canvas, view, occupancy)
        self._go_on(view, trail)
        return self._canvas.copy()

    def _go_on(self, view: Viewport, trail: DrivenPath) -> None:
        pieces, points = self._done
        for number in range(max(0, pieces - 1), len(trail.pieces)):
            piece = trail.pieces[number]
            # The next line begins at the last point drawn.
            first = max(0, points - 1) if number == pieces - 1 else 0
            draw_path(self._canvas, view, piece[first:])
        self._done = len(trail.pieces), len(trail.pieces[-1]) if trail.pieces else 0
