"""Where one frame was in its parent, over the last seconds. Times are nanoseconds."""

from __future__ import annotations

from bisect import bisect_left
from dataclasses import dataclass

from tf2_py.exceptions import ExtrapolationException
from tf2_py.motion import Motion

NEWEST = 0
"""The time that stands for the newest there is."""


@dataclass(frozen=True)
class Sample:
    """Where a frame was at one time."""

    stamp: int
    parent: str
    motion: Motion


class History:
    """The samples of one frame, oldest first; a static frame has one, good for all time."""

    def __init__(self, length: int, *, static: bool) -> None:
        self.static = static
        self.authority = ""
        self._length = length
        self._samples: list[Sample] = []

    def add(self, sample: Sample) -> str | None:
        """Keep a sample; return why not, if it is not kept."""
        if self.static:
            self._samples = [sample]
            return None
        if self._samples and sample.stamp < self.newest - self._length:
            return "it is older than the buffer is long"
        place = bisect_left(self._samples, sample.stamp, key=lambda each: each.stamp)
        if place < len(self._samples) and self._samples[place].stamp == sample.stamp:
            return "there is one of that time already"
        self._samples.insert(place, sample)
        kept = self.newest - self._length
        del self._samples[: bisect_left(self._samples, kept, key=lambda each: each.stamp)]
        return None

    @property
    def newest(self) -> int:
        """The time of the newest sample."""
        return self._samples[-1].stamp

    @property
    def oldest(self) -> int:
        """The time of the oldest sample."""
        return self._samples[0].stamp

    @property
    def parent(self) -> str:
        """The parent in the newest sample."""
        return self._samples[-1].parent

    def __len__(self) -> int:
        return len(self._samples)

    def at(self, time: int) -> Sample:
        """Return the sample of a time, between two if need be; raise ExtrapolationException."""
        samples = self._samples
        if self.static or time in {NEWEST, self.newest}:
            return samples[-1]
        if len(samples) == 1:
            raise ExtrapolationException(
                f"Lookup would require extrapolation at time {seconds(time)}, "
                f"but only time {seconds(self.newest)} is in the buffer"
            )
        if time > self.newest:
            raise ExtrapolationException(
                f"Lookup would require extrapolation into the future.  Requested time "
                f"{seconds(time)} but the latest data is at time {seconds(self.newest)}"
            )
        if time < self.oldest:
            raise ExtrapolationException(
                f"Lookup would require extrapolation into the past.  Requested time "
                f"{seconds(time)} but the earliest data is at time {seconds(self.oldest)}"
            )
        place = bisect_left(samples, time, key=lambda each: each.stamp)
        after = samples[place]
        if after.stamp == time:
            return after
        before = samples[place - 1]
        if before.parent != after.parent:
            return Sample(time, before.parent, before.motion)
        share = (time - before.stamp) / (after.stamp - before.stamp)
        return Sample(time, before.parent, before.motion.towards(after.motion, share))


def seconds(time: int) -> str:
    """Return a time as tf2 writes it."""
    return f"{time / 1e9:.6f}"
