"""The tree of frames over time, and the way from one frame to another in it."""

from __future__ import annotations

import math
import threading
from bisect import bisect_left
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from geometry_msgs.msg import TransformStamped
from rclpy.duration import Duration
from rclpy.logging import get_logger
from rclpy.time import Time

from tf2_py.exceptions import (
    ConnectivityException,
    ExtrapolationException,
    InvalidArgumentException,
    LookupException,
    TransformException,
)

if TYPE_CHECKING:
    from collections.abc import Iterator

Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]

_NEARLY_PARALLEL = 0.9995
"""Above this cosine the straight line differs from the arc by less than rounding does."""


@dataclass(frozen=True)
class Motion:
    """Where a child frame is in its parent."""

    translation: Vector = (0.0, 0.0, 0.0)
    rotation: Quaternion = (0.0, 0.0, 0.0, 1.0)

    def then(self, inner: Motion) -> Motion:
        """Return `inner`, which is within this one, as seen from outside."""
        moved = rotate(self.rotation, inner.translation)
        return Motion(added(self.translation, moved), product(self.rotation, inner.rotation))

    def inverse(self) -> Motion:
        """Return where the parent is in the child."""
        x, y, z, w = self.rotation
        back = (-x, -y, -z, w)
        a, b, c = rotate(back, self.translation)
        return Motion((-a, -b, -c), back)

    def towards(self, other: Motion, share: float) -> Motion:
        """Return what is between two motions; `share` 0 is this one, 1 the other."""
        a, b = self.translation, other.translation
        moved = (a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share, a[2] + (b[2] - a[2]) * share)
        return Motion(moved, slerp(self.rotation, other.rotation, share))


def added(a: Vector, b: Vector) -> Vector:
    """Return the sum of two vectors."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def product(a: Quaternion, b: Quaternion) -> Quaternion:
    """Return the rotation `b` followed by the rotation `a`."""
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    )


def rotate(turn: Quaternion, vector: Vector) -> Vector:
    """Return a vector after a rotation."""
    x, y, z, w = turn
    inside = product(product(turn, (*vector, 0.0)), (-x, -y, -z, w))
    return inside[0], inside[1], inside[2]


def unit(turn: Quaternion) -> Quaternion:
    """Return a quaternion of length 1."""
    length = math.hypot(*turn)
    return turn[0] / length, turn[1] / length, turn[2] / length, turn[3] / length


def slerp(a: Quaternion, b: Quaternion, share: float) -> Quaternion:
    """Return the rotation between two, by the shorter way round."""
    cosine = sum(p * q for p, q in zip(a, b, strict=True))
    sign = -1.0 if cosine < 0 else 1.0
    cosine = abs(cosine)
    if cosine > _NEARLY_PARALLEL:
        left, right = 1.0 - share, share
    else:
        angle = math.acos(cosine)
        left = math.sin((1.0 - share) * angle) / math.sin(angle)
        right = math.sin(share * angle) / math.sin(angle)
    right *= sign
    return unit(
        (
            a[0] * left + b[0] * right,
            a[1] * left + b[1] * right,
            a[2] * left + b[2] * right,
            a[3] * left + b[3] * right,
        )
    )


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


DEEPEST = 1000
"""A way longer than this goes in a circle."""

NOT_A_ROTATION = 0.01
"""How far the square of a quaternion's length may be from 1."""


class BufferCore:
    """Keeps transforms, and answers where a frame is in another; safe between threads."""

    def __init__(self, cache_time: Duration | None = None) -> None:
        self._length = (cache_time or Duration(seconds=10)).nanoseconds
        self._lock = threading.RLock()
        self._histories: dict[str, History] = {}
        self._known: dict[str, None] = {}

    def set_transform(self, transform: Any, authority: str) -> None:
        """Keep a transform of its time."""
        self._set(transform, authority, static=False)

    def set_transform_static(self, transform: Any, authority: str) -> None:
        """Keep a transform that holds at any time."""
        self._set(transform, authority, static=True)

    def clear(self) -> None:
        """Forget all transforms that have a time."""
        with self._lock:
            self._histories = {name: kept for name, kept in self._histories.items() if kept.static}

    def lookup_transform_core(self, target_frame: str, source_frame: str, time: Time) -> Any:
        """Return where the source frame is in the target frame; raise TransformException."""
        with self._lock:
            self._check("lookup_transform", target_frame, source_frame)
            when = _nanoseconds(time)
            if when == NEWEST:
                when = self._common_time(target_frame, source_frame)
            return _message(target_frame, source_frame, when, self._motion(target_frame, source_frame, when))

    def lookup_transform_full_core(
        self, target_frame: str, target_time: Time, source_frame: str, source_time: Time, fixed_frame: str
    ) -> Any:
        """Return the same between two times, for which the fixed frame stands still."""
        with self._lock:
            self._check("lookup_transform_full", target_frame, source_frame, fixed_frame)
            then = self.lookup_transform_core(fixed_frame, source_frame, source_time)
            now = self.lookup_transform_core(target_frame, fixed_frame, target_time)
            motion = _motion_of(now.transform).then(_motion_of(then.transform))
            stamp = Time.from_msg(now.header.stamp).nanoseconds
            return _message(target_frame, source_frame, stamp, motion)

    def can_transform_core(self, target_frame: str, source_frame: str, time: Time) -> tuple[bool, str]:
        """Return whether there is a transform, and if not, why."""
        try:
            self.lookup_transform_core(target_frame, source_frame, time)
        except TransformException as error:
            return False, str(error)
        return True, ""

    def can_transform_full_core(
        self, target_frame: str, target_time: Time, source_frame: str, source_time: Time, fixed_frame: str
    ) -> tuple[bool, str]:
        """Return whether there is a transform between two times, and if not, why."""
        try:
            self.lookup_transform_full_core(target_frame, target_time, source_frame, source_time, fixed_frame)
        except TransformException as error:
            return False, str(error)
        return True, ""

    def get_latest_common_time(self, target_frame: str, source_frame: str) -> Time:
        """Return the newest time at which the two are connected, 0 if at any time."""
        with self._lock:
            self._check("get_latest_common_time", target_frame, source_frame)
            return Time(nanoseconds=self._common_time(target_frame, source_frame))

    def all_frames_as_string(self) -> str:
        """Return one line for each frame that has a parent."""
        with self._lock:
            return "".join(
                f"Frame {_in_line(name)} exists with parent {_in_line(history.parent)}.\n"
                for name, history in self._histories.items()
            )

    def all_frames_as_yaml(self) -> str:
        """Return a mapping of frames to parents, times and rates."""
        with self._lock:
            found = [_yaml(name, history) for name, history in self._histories.items()]
        return "".join(found) or "{}\n"

    def _frameExists(self, frame_id: str) -> bool:  # noqa: N802 - tf2's own names
        return frame_id in self._known

    def _getFrameStrings(self) -> list[str]:  # noqa: N802
        return list(self._known)

    def _set(self, transform: Any, authority: str, *, static: bool) -> None:
        child = transform.child_frame_id.removeprefix("/")
        parent = transform.header.frame_id.removeprefix("/")
        why = _fault(transform, parent, child)
        if why is None:
            motion = _motion_of(transform.transform)
            stamp = Time.from_msg(transform.header.stamp).nanoseconds
            with self._lock:
                history = self._histories.get(child)
                if history is None or history.static != static:
                    history = History(self._length, static=static)
                why = history.add(Sample(stamp, parent, motion))
                history.authority = authority
                if len(history):
                    self._histories[child] = history
                    self._known |= {parent: None, child: None}
        if why is not None:
            get_logger("tf2").warning(
                f"the transform from '{parent}' to '{child}' of {authority} is ignored: {why}",
                throttle_duration_sec=1.0,
            )

    def _check(self, function: str, *frames: str) -> None:
        for frame in frames:
            if not frame:
                raise InvalidArgumentException(f"Invalid argument passed to {function}: a frame_id cannot be empty")
            if frame.startswith("/"):
                raise InvalidArgumentException(
                    f"Invalid argument '{frame}' passed to {function}: in tf2 frame_ids cannot start with a '/'"
                )
        for frame in frames:
            if frame not in self._known:
                raise LookupException(f'"{frame}" passed to {function} does not exist.')

    def _common_time(self, target: str, source: str) -> int:
        """Return the newest time of all samples on the way, NEWEST if all of them are static."""
        ways = [[step for step, _ in self._upwards(frame)] for frame in (source, target)]
        top = next((step for step in ways[0] if step in ways[1]), None)
        if top is None:
            raise ConnectivityException(_unconnected(target, source))
        passed = [step for way in ways for step in way[: way.index(top)]]
        stamps = [self._histories[step].newest for step in passed if not self._histories[step].static]
        return min(stamps, default=NEWEST)

    def _upwards(self, frame: str) -> Iterator[tuple[str, History | None]]:
        """Yield a frame, its parent, and so on, by the newest samples."""
        for _ in range(DEEPEST):
            history = self._histories.get(frame)
            yield frame, history
            if history is None:
                return
            frame = history.parent

    def _motion(self, target: str, source: str, time: int) -> Motion:
        from_source, why_source = self._ancestors(source, time)
        from_target, why_target = self._ancestors(target, time)
        for ancestor, motion in from_source.items():
            if ancestor in from_target:
                return from_target[ancestor].inverse().then(motion)
        why = why_source or why_target
        if why is not None:
            raise ExtrapolationException(
                f"{why}, when looking up transform from frame [{source}] to frame [{target}]"
            )
        raise ConnectivityException(_unconnected(target, source))

    def _ancestors(self, frame: str, time: int) -> tuple[dict[str, Motion], ExtrapolationException | None]:
        """Return where a frame was in each frame above it, and why that ends before the root."""
        motion = Motion()
        found = {frame: motion}
        while history := self._histories.get(frame):
            try:
                sample = history.at(time)
            except ExtrapolationException as error:
                return found, error
            motion, frame = sample.motion.then(motion), sample.parent
            if frame in found:
                raise LookupException(f'The frame "{frame}" is above itself in the tree.')
            found[frame] = motion
        return found, None


def _nanoseconds(time: Any) -> int:
    if not isinstance(time, Time):
        raise TypeError(
            f"the time has to be a rclpy.time.Time and not {type(time).__name__}; "
            "rclpy.time.Time.from_msg makes one of a message's stamp"
        )
    return int(time.nanoseconds)


def _motion_of(transform: Any) -> Motion:
    moved, turned = transform.translation, transform.rotation
    return Motion((moved.x, moved.y, moved.z), unit((turned.x, turned.y, turned.z, turned.w)))


def _message(target: str, source: str, time: int, motion: Motion) -> Any:
    found = TransformStamped()
    found.header.stamp = Time(nanoseconds=time).to_msg()
    found.header.frame_id = target
    found.child_frame_id = source
    moved, turned = found.transform.translation, found.transform.rotation
    moved.x, moved.y, moved.z = motion.translation
    turned.x, turned.y, turned.z, turned.w = motion.rotation
    return found


def _fault(transform: Any, parent: str, child: str) -> str | None:
    """Return what is wrong with a transform itself."""
    if not child or not parent:
        return "a frame has no name"
    if child == parent:
        return "a frame cannot be its own parent"
    moved, turned = transform.transform.translation, transform.transform.rotation
    numbers = (moved.x, moved.y, moved.z, turned.x, turned.y, turned.z, turned.w)
    if not all(map(math.isfinite, numbers)):
        return "one of its numbers is not a number"
    square = sum(each * each for each in numbers[3:])
    if abs(square - 1.0) > NOT_A_ROTATION:
        return f"its quaternion is no rotation: its length is {math.sqrt(square):.3f} and not 1"
    return None


def _unconnected(target: str, source: str) -> str:
    return (
        f"Could not find a connection between '{target}' and '{source}' because they are not part "
        "of the same tree. Tf has two or more unconnected trees."
    )


def _in_line(name: str) -> str:
    """Keep a name with line breaks, as anybody may publish one, in its line."""
    return name.replace("\n", "\N{SYMBOL FOR LINE FEED}").replace("\r", "")


def _yaml(name: str, history: History) -> str:
    length = (history.newest - history.oldest) / 1e9
    rate = len(history) / max(length, 0.0001)
    return (
        f"{name}: \n"
        f"  parent: '{history.parent}'\n"
        f"  broadcaster: '{history.authority}'\n"
        f"  rate: {rate:.3f}\n"
        f"  most_recent_transform: {seconds(history.newest)}\n"
        f"  oldest_transform: {seconds(history.oldest)}\n"
        f"  buffer_length: {length:.3f}\n"
    )
