"""Trees of any installed type, with values from the types of its fields."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any

import numpy as np
from hypothesis import strategies as st

from graph.messages.browse import interfaces
from graph.messages.fields import BYTES, INTEGERS, FieldType, fields_of, parse
from graph.messages.types import load_message

TYPES = tuple(name for name in interfaces() if "/msg/" in name)
"""All messages, those of services and actions left out."""

TEXTS = st.text(st.characters(codec="utf-8", exclude_characters="\0"), max_size=5) | st.sampled_from(
    ["on", "~", "1e3", "12:30", "nan", "- a", "a: b", "# c", "\t", " x ", "\x85", "\ufeff", "\x1b[1m"]
)
_SINGLE: dict[str, st.SearchStrategy[Any]] = {
    "boolean": st.booleans(),
    "string": TEXTS,
    "wstring": TEXTS,
    "float": st.floats(width=32),
    "double": st.floats(width=64),
    **{name: st.integers(*limits) for name, limits in INTEGERS.items()},
}


def trees_of(cls: type[Any]) -> st.SearchStrategy[dict[str, Any]]:
    """Return trees with every field of this class, made once."""
    kind: Any = cls
    return _trees_of(kind)


@lru_cache(maxsize=1024)
def _trees_of(cls: Any) -> st.SearchStrategy[dict[str, Any]]:
    return st.fixed_dictionaries({name: _values(parse(kind)) for name, kind in fields_of(cls)})


def _values(kind: FieldType) -> st.SearchStrategy[Any]:
    if kind.is_many:
        least, most = (kind.size, kind.size) if kind.size is not None else (0, 3)
        if kind.limit is not None:
            most = min(most, kind.limit)
        if kind.element in BYTES:
            return st.binary(min_size=least, max_size=most)
        single = FieldType(kind.element, text_limit=kind.text_limit)
        return st.lists(_values(single), min_size=least, max_size=most)
    if kind.is_message:
        return trees_of(load_message(kind.element.replace("/", "/msg/")))
    if kind.text_limit is not None:
        return st.text("abc", max_size=kind.text_limit)
    return _SINGLE[kind.element]


def same(left: Any, right: Any) -> bool:
    """Compare trees; nan is itself, and an array is its list."""
    if isinstance(left, dict):
        return left.keys() == right.keys() and all(same(left[k], right[k]) for k in left)
    if isinstance(left, (np.ndarray, bytes)):
        left = list(left) if isinstance(left, bytes) else left.tolist()
    if isinstance(right, (np.ndarray, bytes)):
        right = list(right) if isinstance(right, bytes) else right.tolist()
    if isinstance(left, list):
        return len(left) == len(right) and all(map(same, left, right))
    if isinstance(left, float) and math.isnan(left):
        return math.isnan(right)
    return bool(left == right)
