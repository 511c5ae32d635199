"""One frame in one of its parents, as somebody hears it on /tf or /tf_static."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from space.buffer import Stamped

STALE_PERIODS, STALE_S = 5.0, 1.0
"""A moving frame is stale after so many of its periods, and never sooner than that."""
ONCE_S = 3.0
"""One that has come only once is stale after this long."""


class HeardFrame(Protocol):
    """What is known of it; `graph.data.FrameRow` is one."""

    @property
    def newest(self) -> Stamped:
        """Where it was last."""

    @property
    def is_static(self) -> bool:
        """Whether it comes from /tf_static."""

    @property
    def count(self) -> int:
        """How many have come."""

    @property
    def hz(self) -> float | None:
        """Per second; None if that is unknown, and for a static one."""

    @property
    def age_s(self) -> float:
        """Since the newest came."""

    @property
    def delay_s(self) -> float:
        """Arrival minus stamp of the newest."""

    @property
    def publishers(self) -> tuple[str, ...]:
        """The nodes that publish it, or that may; empty if all of them have gone."""

    @property
    def certain(self) -> bool:
        """Whether all of them do; otherwise one of them does, perhaps more."""

    @property
    def gone(self) -> str:
        """The node that published it last, if that is known and has gone."""

    @property
    def fault(self) -> str:
        """Why one of the last seconds was not taken, a sentence about the frame."""

    @property
    def faults(self) -> int:
        """How many were not taken."""

    @property
    def slashed(self) -> bool:
        """Whether somebody publishes it with a leading slash."""

    @property
    def moved(self) -> bool:
        """Whether a static one keeps changing, or comes from two nodes with different numbers."""

    @property
    def contested(self) -> bool:
        """Whether several publishers send it by turns."""


def is_stale(heard: HeardFrame) -> bool:
    """Return whether a moving frame has been silent for longer than a few of its periods."""
    if heard.is_static:
        return False
    if heard.hz is None:
        return heard.age_s > ONCE_S
    return heard.age_s > max(STALE_S, STALE_PERIODS / max(heard.hz, 1e-3))
