"""Reads `tf2_msgs/TFMessage` from its bytes, some twenty times as fast as rclpy does.

A publisher sends the same frames again and again, so that its messages differ in their numbers
alone. The format of all of them is made from the first one, and the names are only compared.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from graph.data import Value

TF_MESSAGE = "tf2_msgs/msg/TFMessage"
LITTLE_ENDIAN_CDR = b"\x00\x01"
ENCAPSULATION = 4
"""Bytes before the body, from whose beginning alignment counts (OMG DDS-XTypes 1.3, 7.4.1)."""
FIELDS = 11
"""Of one transform: seconds, nanoseconds, parent, child, translation and rotation."""
NUMBERS = struct.Struct("<7d")
MOST_LAYOUTS, MOST_BYTES = 256, 4_000_000
"""That are remembered; whoever sends other names each time makes Deck begin anew."""
MOST_FORMS = 8
"""Formats that are tried for messages of one size."""

Names = tuple[tuple[str, str], ...]
"""Parent and child of each transform of a message."""


class Transforms(NamedTuple):
    """The transforms of one message: the same `names` are the same object as a rule."""

    names: Names
    fields: Iterator[tuple[Any, ...]]
    """For each: seconds, nanoseconds, two that do not matter, x, y, z, and the quaternion x, y, z,
    w."""


@dataclass(frozen=True)
class _KnownLayout:
    """Where the numbers of a message are, and its names."""

    form: struct.Struct
    raw_names: tuple[bytes, ...]
    """All parents, then all children, each with its length before it."""
    names: Names


class TransformReader:
    """Reads the messages of one topic."""

    def __init__(self, decode: Callable[[bytes], Mapping[str, Value]]) -> None:
        """`decode` makes a tree of messages in another representation than little-endian CDR."""
        self._decode = decode
        self._forms: dict[tuple[int, bytes], list[struct.Struct]] = {}
        """Size and number of transforms to the formats that such messages had."""
        self._layouts: dict[tuple[str | bytes, tuple[bytes, ...]], _KnownLayout] = {}
        self._bytes = 0
        """Of the messages that the layouts were made from."""

    def read(self, raw: bytes) -> Transforms:
        """Return the transforms of a message.

        Raises ValueError for bytes that are no such message, and what `decode` raises.
        """
        if raw[:2] != LITTLE_ENDIAN_CDR:
            return _from_tree(self._decode(raw))
        for form in self._forms.get(_kind(raw), ()):
            fields = form.unpack_from(raw)
            raw_names = fields[2::FIELDS] + fields[3::FIELDS]
            layout = self._layouts.get((form.format, raw_names))
            if layout is not None:
                return _from_fields(layout, fields)
        layout = _layout(raw)
        self._remember(raw, layout)
        return _from_fields(layout, layout.form.unpack_from(raw))

    def _remember(self, raw: bytes, layout: _KnownLayout) -> None:
        self._bytes += len(raw)
        if len(self._layouts) >= MOST_LAYOUTS or self._bytes > MOST_BYTES:
            self._layouts.clear()
            self._forms.clear()
            self._bytes = len(raw)
        if len(raw) > MOST_BYTES:
            return
        self._layouts[layout.form.format, layout.raw_names] = layout
        forms = self._forms.setdefault(_kind(raw), [])
        if all(form.format != layout.form.format for form in forms):
            forms.insert(0, layout.form)
            del forms[MOST_FORMS:]


def _kind(raw: bytes) -> tuple[int, bytes]:
    return len(raw), raw[ENCAPSULATION : ENCAPSULATION + 4]


def _from_fields(layout: _KnownLayout, fields: tuple[Any, ...]) -> Transforms:
    return Transforms(layout.names, zip(*[iter(fields)] * FIELDS, strict=True))


def _layout(raw: bytes) -> _KnownLayout:
    """Find out where what is. The bytes that fill gaps may have any value."""
    form, parents, children = ["<4x4x"], [], []
    count, at = _length(raw, ENCAPSULATION)
    for _ in range(count):
        begin = at + 8
        parent, at = _text(raw, begin)
        gap = -(at - ENCAPSULATION) % 4
        child, end = _text(raw, at + gap)
        at = end + -(end - ENCAPSULATION) % 8 + NUMBERS.size
        if at > len(raw):
            raise ValueError("the message ends too early")
        form.append(f"iI{len(parent)}s{gap}x{len(child)}s{at - NUMBERS.size - end}x7d")
        parents.append(parent)
        children.append(child)
    names = tuple(zip(map(_name, parents), map(_name, children), strict=True))
    return _KnownLayout(struct.Struct("".join(form)), (*parents, *children), names)


def _length(raw: bytes, at: int) -> tuple[int, int]:
    if at + 4 > len(raw):
        raise ValueError("the message ends too early")
    return int.from_bytes(raw[at : at + 4], "little"), at + 4


def _text(raw: bytes, at: int) -> tuple[bytes, int]:
    """Return a text with its length before it, and where it ends."""
    length, begin = _length(raw, at)
    if begin + length > len(raw):
        raise ValueError("the message ends too early")
    return raw[at : begin + length], begin + length


def _name(text: bytes) -> str:
    return text[4:].removesuffix(b"\0").decode(errors="replace")


def _from_tree(tree: Mapping[str, Any]) -> Transforms:
    found = tree["transforms"]
    names = tuple((one["header"]["frame_id"], one["child_frame_id"]) for one in found)
    return Transforms(names, iter([_fields_of(one) for one in found]))


def _fields_of(one: Mapping[str, Any]) -> tuple[Any, ...]:
    stamp, moved, turned = (one["header"]["stamp"], one["transform"]["translation"], one["transform"]["rotation"])
    return (
        stamp["sec"],
        stamp["nanosec"],
        b"",
        b"",
        *(moved[axis] for axis in "xyz"),
        *(turned[axis] for axis in "xyzw"),
    )
