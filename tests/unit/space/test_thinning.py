"""Clouds with fewer points that look the same."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from space.drawing.shapes import Speckles
from space.drawing.thinning import thinned


def cloud(seed: int, count: int = 5000, size: float = 4.0) -> Speckles:
    """Points in a room."""
    rng = np.random.default_rng(seed)
    places = rng.uniform(-size, size, (count, 3)).astype(np.float32)
    return Speckles(places, np.full(count, 7, dtype=np.uint8))


@given(seed=st.integers(0, 1000), cube_m=st.floats(0.02, 2.0), size=st.floats(0.1, 500))
def test_every_point_has_one_close_by_and_none_is_made_up(
    seed: int, cube_m: float, size: float
) -> None:
    points = cloud(seed, size=size)
    fewer = thinned(points, cube_m)
    assert 0 < len(fewer.places) <= len(points.places)
    edge = cube_m
    while (2 * size / edge + 2) ** 3 > 8_000_000:
        edge *= 2
    for place in points.places[::500]:
        assert np.abs(fewer.places - place).max(axis=1).min() <= edge * 1.05
    for place in fewer.places[::500]:
        assert np.abs(points.places - place).max(axis=1).min() <= edge * 1.05


def test_noise_within_a_cube_moves_nothing() -> None:
    rng = np.random.default_rng(1)
    middles = (rng.integers(-20, 20, (5000, 3)) + 0.5) * 0.1
    first, second = (
        thinned(
            Speckles((middles + rng.uniform(-0.04, 0.04, middles.shape)).astype(np.float32)), 0.1
        )
        for _time in range(2)
    )
    assert np.array_equal(first.places, second.places)


def test_a_point_keeps_its_paint() -> None:
    left = Speckles(
        np.concatenate([np.full((3000, 3), -1.0), np.full((3000, 3), 1.0)]).astype(np.float32),
        np.repeat(np.array([5, 6], dtype=np.uint8), 3000),
    )
    fewer = thinned(left, 0.1)
    assert isinstance(fewer.paint, np.ndarray)
    assert {
        (bool(x > 0), int(paint)) for x, paint in zip(fewer.places[:, 0], fewer.paint, strict=True)
    } == {
        (False, 5),
        (True, 6),
    }


def test_few_points_stay_as_they_are() -> None:
    points = cloud(1, 100)
    assert thinned(points, 1.0) is points
