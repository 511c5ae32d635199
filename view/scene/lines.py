"""Lines of what is read for the screen of the terminal, in the viewer's colours."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from space.drawing.paints import Tint
from space.drawing.shapes import Strokes

if TYPE_CHECKING:
    from collections.abc import Iterable

    from space.drawing.shapes import Places, Shape

COLOURS: dict[int, tuple[int, int, int]] = {Tint.MUTED: (120, 120, 120), Tint.WARN: (80, 200, 255)}
GREEN = (60, 220, 90)
RADIUS_M = 0.01


def lines(shapes: Iterable[Shape], radius_m: float = RADIUS_M) -> Any:  # noqa: ANN401 - rerun comes without types
    """Return the strokes of these shapes, each of one tint."""
    import rerun

    strips: list[Places] = []
    colours: list[tuple[int, int, int]] = []
    for shape in shapes:
        if isinstance(shape, Strokes):
            assert isinstance(shape.paint, int)
            pieces = _pieces(shape)
            strips += pieces
            colours += [COLOURS.get(shape.paint, GREEN)] * len(pieces)
    return rerun.LineStrips3D(strips, colors=colours, radii=radius_m)


def _pieces(strokes: Strokes) -> list[Places]:
    """Return lines from point to point, each as long as a stroke begins where one has ended."""
    if not len(strokes.starts):
        return []
    torn = np.flatnonzero((strokes.ends[:-1] != strokes.starts[1:]).any(axis=1)) + 1
    both = zip(np.split(strokes.starts, torn), np.split(strokes.ends, torn), strict=True)
    return [np.concatenate([starts[:1], ends]) for starts, ends in both]
