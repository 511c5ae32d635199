"""One file of a bag, of whatever format, behind one interface for reading it."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, Protocol

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Sequence
    from pathlib import Path

    from graph.bag.decoding import TypeText

CDR = "cdr"
Found = tuple[int, int, bytes]
"""Unix time in nanoseconds, number of the channel, raw message."""


class Channel(NamedTuple):
    """One topic of one file, of one type."""

    number: int
    topic: str
    kind: TypeText
    messages: int = 0
    encoding: str = CDR
    """How its messages are written. Only ROS 2's own, CDR, can be decoded and published."""
    reliability: str = ""
    durability: str = ""
    """QoS offered by its first publisher, empty if the file does not say."""


class Lost(NamedTuple):
    """A place of a file that cannot be read."""

    at_ns: int
    """Unix time of its first message, if known."""
    messages: int | None
    """How many messages it held, None if that is not known."""


class BagPart(Protocol):
    """An open file of a bag."""

    file: Path
    """As it is in the folder of the bag; what is read may be an unpacked copy."""
    channels: Sequence[Channel]
    start_ns: int
    end_ns: int
    """Unix time of the first and of the last message, 0 if there is none."""
    distro: str
    """ROS distribution that wrote the file, empty if it does not say."""
    said: int | None
    """How many messages it holds by its own count, None if it keeps none."""
    cut_bytes: int | None
    """Length of what cannot be read at the end of a file without an end; None for a whole one."""

    @property
    def lost(self) -> Sequence[Lost]:
        """What has turned out to be damaged so far; grows while messages are read."""

    def messages(self, start_ns: int | None, numbers: Collection[int]) -> Iterator[Found]:
        """Yield messages of these channels in the order of their times."""

    def close(self) -> None:
        """Let go of the file."""
