"""Messages as trees, as the readers of space are given them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from space.transform import Transform


def header(frame: str) -> dict[str, Any]:
    return {"stamp": {"sec": 0, "nanosec": 0}, "frame_id": frame}


def pose_tree(transform: Transform) -> dict[str, Any]:
    return {
        "position": dict(zip("xyz", transform.translation, strict=True)),
        "orientation": dict(zip("xyzw", transform.rotation, strict=True)),
    }


def cloud_tree(places: np.ndarray[Any, Any], frame: str, **more: Any) -> dict[str, Any]:
    """A cloud of float32 x, y, z."""
    fields = [{"name": name, "offset": 4 * at, "datatype": 7, "count": 1} for at, name in enumerate("xyz")]
    tree = {
        "header": header(frame),
        "height": 1,
        "width": len(places),
        "fields": fields,
        "is_bigendian": False,
        "point_step": 12,
        "row_step": 12 * len(places),
        "data": places.astype("<f4").tobytes(),
        "is_dense": False,
    }
    return {**tree, **more}


def marker(number: int, kind: int, at: Transform, size: Sequence[float], **more: Any) -> dict[str, Any]:
    colour = {"r": 1.0, "g": 0.5, "b": 0.0, "a": 1.0}
    tree = {
        "header": header("map"),
        "ns": "things",
        "id": number,
        "type": kind,
        "action": 0,
        "pose": pose_tree(at),
        "scale": dict(zip("xyz", size, strict=True)),
        "color": colour,
        "lifetime": {"sec": 0, "nanosec": 0},
        "points": [],
        "colors": [],
        "text": "",
    }
    return {**tree, **more}
