"""Streams of bytes for decoders: cut anywhere, bits turned over, noise."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations, pairwise

from hypothesis import strategies as st

noise = st.binary(max_size=300)


def cut(data: bytes, places: list[int]) -> list[bytes]:
    ends = sorted({0, len(data), *(place % (len(data) + 1) for place in places)})
    return [data[begin:end] for begin, end in pairwise(ends)]


def flipped(data: bytes, most: int) -> Iterator[bytes]:
    """The data with every choice of 1 to `most` bits turned over."""
    whole = int.from_bytes(data, "big")
    for count in range(1, most + 1):
        for bits in combinations(range(8 * len(data)), count):
            yield (whole ^ sum(1 << bit for bit in bits)).to_bytes(len(data), "big")
