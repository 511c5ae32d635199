"""A picture of the size that is shown: thinned out first, coloured after.

A picture of 1280x720 has thirty times the pixels that a terminal shows: skipping the others is
what makes ten pictures a second cheap. numpy is imported in the functions, see `graph.pictures.pixels`.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeAlias

from graph.pictures.pixels import grey

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from graph.pictures.pixels import Rgb

Fit: TypeAlias = "Callable[[int, int], tuple[int, int]]"
"""From width and height of a picture to the wanted width and height, in pixels."""
METRES = {"16UC1": 1e-3, "32FC1": 1.0}
"""Metres of one unit of the depth encodings (source: REP-118)."""
FARTHEST = 99.0
"""Percent of the readings between `near` and `far`: outliers must not use up the colours."""
RAMP = ((253, 231, 37), (94, 201, 98), (33, 145, 140), (59, 82, 139), (68, 1, 84))
"""From near to far: steadily darker, so that it is readable without colours, too (viridis)."""


@dataclass(frozen=True)
class Picture:
    """A picture at the wanted size."""

    rgb: Rgb
    width: int
    height: int
    """Size of the message's own picture, in pixels."""
    encoding: str
    range_m: tuple[float, float] | None = None
    """For depth: the values of the first and the last colour of the ramp; None if none is valid."""

    @property
    def is_empty_depth(self) -> bool:
        """Whether it is depth of which not one reading is a distance: NaN, infinite or zero."""
        return self.encoding in METRES and self.range_m is None


def numbers_picture(
    numbers: NDArray[Any], size: tuple[int, int], encoding: str, every: NDArray[np.generic]
) -> Picture:
    """Return numbers of shape (height, width) as a picture: depth by the ramp, others in grey.

    They are a choice of `every` number of the message, by which is judged whether there is any distance; `size` is
    the width and height of those.
    """
    if encoding not in METRES:
        return Picture(grey(numbers), *size, encoding)
    import numpy as np

    metres, valid = _measured(numbers, encoding)
    distances = metres[valid]
    if not distances.size:
        all_metres, all_valid = _measured(every, encoding)
        distances = all_metres[all_valid]
    if not distances.size:
        return Picture(np.zeros((*metres.shape, 3), np.uint8), *size, encoding)
    near, far = rounded(*np.percentile(distances, (100 - FARTHEST, FARTHEST)).tolist())
    share = np.clip((np.where(valid, metres, near) - near) / (far - near), 0.0, 1.0)
    rgb = ramp_colours()[(share * 255).astype(np.uint8)]
    rgb[~valid] = 0
    return Picture(rgb, *size, encoding, (near, far))


def _measured(numbers: NDArray[np.generic], encoding: str) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Return numbers in metres, and which of them are distances."""
    import numpy as np

    metres: NDArray[np.float64] = numbers.astype(np.float64) * METRES[encoding]
    return metres, np.isfinite(metres) & (metres > 0)


def ramp_colours() -> Rgb:
    """Return the colour ramp of depth from near to far, shape (256, 3)."""
    import numpy as np

    at = np.linspace(0, len(RAMP) - 1, 256)
    channels = [np.interp(at, range(len(RAMP)), channel) for channel in zip(*RAMP, strict=True)]
    colours: Rgb = np.stack(channels, axis=1).astype(np.uint8)
    return colours


def rounded(near: float, far: float) -> tuple[float, float]:
    """Return the range widened a little to round numbers: it must not jitter with every picture."""
    span = max(far - near, 0.01 * far, 1e-3)
    step = 10.0 ** math.floor(math.log10(span))
    step = step / 2 if span < 5 * step else step
    low, high = math.floor(near / step + 1e-9) * step, math.ceil(far / step - 1e-9) * step
    return low, high if high > low else low + step


def thinned(pixels: NDArray[Any], fit: Fit) -> NDArray[Any]:
    """Return every n-th pixel, shape (height, width, n); all pixels if the picture is small."""
    import numpy as np

    height, width = pixels.shape[:2]
    wide, high = fit(width, height)
    if wide >= width and high >= height:
        return pixels
    wide, high = max(1, min(wide, width)), max(1, min(high, height))
    rows = (np.arange(high) * height + height // 2) // high
    columns = (np.arange(wide) * width + width // 2) // wide
    fewer: NDArray[Any] = pixels[rows[:, None], columns]
    return fewer
