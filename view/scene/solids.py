"""Solid shapes in Rerun: of one size, turned alike, one at each of its places."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from space.transform import Quaternion, Vector


@dataclass(frozen=True, eq=False)
class Solids:
    """Where they are, and how large."""

    middles: NDArray[np.floating]
    """Shape (n, 3)."""
    rotation: Quaternion
    size_m: Vector
    rgba: NDArray[np.uint8]
    """A row for each, or one for all, 0 to 255."""

    def boxes(self) -> Any:  # noqa: ANN401 - rerun comes without types
        import rerun

        return rerun.Boxes3D(sizes=self._each(self.size_m), **self._placed())

    def ellipsoids(self) -> Any:  # noqa: ANN401
        """Return ellipsoids, whose diameters their size is."""
        import rerun

        return rerun.Ellipsoids3D(half_sizes=self._each(self.size_m) / 2, **self._placed())

    def cylinders(self) -> Any:  # noqa: ANN401
        """Return cylinders about z, round though x and y of their size may differ."""
        import rerun

        wide, _, high = self._each(self.size_m).T
        return rerun.Cylinders3D(lengths=high, radii=wide / 2, **self._placed())

    def _each(self, numbers: Vector | Quaternion) -> NDArray[np.float64]:
        return np.tile(numbers, (len(self.middles), 1))

    def _placed(self) -> dict[str, Any]:
        return {
            "centers": self.middles,
            "quaternions": self._each(self.rotation),
            "colors": self.rgba,
            "fill_mode": "solid",
        }
