"""The emergency stop as a node obeys it: latched until it is released by an explicit false.

A stop takes effect first; then it is published on /emergency_stop_state, and then saved to disk. A
stop that one node has heard is a stop of all: each of them takes what it has not heard itself from
the state that the others publish, and from the disk, whichever is sooner, and so it does with a
release. `safety.stop_record` says what follows if these contradict each other.
"""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable, Iterable
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from rclpy.event_handler import PublisherEventCallbacks
from rclpy.impl.implementation_singleton import rclpy_implementation as rclpy_c
from rclpy.topic_endpoint_info import TopicEndpointInfo
from std_msgs.msg import Bool

from nodes.parts.node import DEPTH, LATCHED, LessonNode, PeriodicThread
from nodes.parts.stop_news import FREE, HELD, OF_MANY, named, read_reports, report_message
from safety.known_stops import Heard, KnownStops
from safety.stop_file import TOPIC, KeptStop, StopFile
from safety.stop_record import Insistence, Stop, StopRecord
from safety.topics import EMERGENCY_STATE, EMERGENCY_STOP
from text.i18n import N_

_EVERY_S = 0.05
_STILL_S, _JUST_S = 0.5, 1.0
"""What is no delay of a busy machine any more, and how long everything that was late arrives."""


class StopWatch:
    """Calls back on the node's own thread after each change of the saved stop, and when asked to.

    So a stop reaches a node that the middleware does not connect yet. The files are looked at 20 times
    a second, on a thread that costs some 20 microseconds each time: that works on every file system,
    and where a user has no watches left.
    """

    def __init__(self, node: LessonNode, file: StopFile, changed: Callable[[], None]) -> None:
        """Watch from now on; read the file after this."""
        self._node, self._file, self._changed = node, file, changed
        self._seen = file.signature()
        self._due_s: float | None = None
        self._thread = PeriodicThread(_EVERY_S, self._look)
        self._looked_s, self._still_s = time.monotonic(), -_JUST_S

    def start(self) -> None:
        self._thread.start()

    @property
    def was_frozen(self) -> bool:
        """Whether this process has stood still a moment ago."""
        now_s = time.monotonic()
        return now_s - self._looked_s > _STILL_S or now_s - self._still_s < _JUST_S

    def call_later(self, after_s: float) -> None:
        """Call back after this time too, sooner if the files change."""
        if self._due_s is None:
            self._due_s = time.monotonic() + after_s

    def _look(self) -> None:
        now_s = time.monotonic()
        if now_s - self._looked_s > _STILL_S:
            self._still_s = now_s
        self._looked_s = now_s
        seen, due_s, executor = self._file.signature(), self._due_s, self._node.executor
        due = due_s is not None and now_s >= due_s
        if executor is None or not (due or seen != self._seen):
            return
        # A node that is ending has given these up.
        with contextlib.suppress(AttributeError, rclpy_c.InvalidHandle):
            self._due_s = None
            executor.create_task(self._changed)
            self._seen = seen


PICO = "pico"
"""What engaged it."""
_TOLD_EVERY_S = 1.0
_AGAIN_S = 0.1
"""What others need not know at once is sent with what follows within this time."""
_JUST_NOW_NS = 1_000_000_000
_MOST_NAMES = 16
_CONTRADICTED_S = 10.0
"""So long after a release that had no effect it is said that there was one."""
_UNKNOWN = "_UNKNOWN_"
"""In the names of a node whose endpoint is known but whose name is not yet (rmw)."""

_REMEMBERED = N_("EMERGENCY STOP, given before this node was started ({at}): nothing moves until it is released")
_UNREADABLE = N_(
    "It is not known whether an emergency stop was given before ({problem}): nothing moves until one is released"
)
_NOT_KEPT = N_("The emergency stop holds, but cannot be written to disk ({problem}): it would not outlive this node")
_NOT_FORGOTTEN = N_("The emergency stop is released, but stays on disk ({problem}): the next start will be stopped")
_UNPLACED = N_(
    "A release of the emergency stop has no effect: it is {seconds:.1f} s old by the clock of this"
    " computer, so that it came late, or by another clock. Release it again"
)
_CONTRADICTED = N_(
    "The emergency stop is not released: somebody releases it while another keeps giving it ({publishers})"
)


class EmergencyStopListener:
    """Subscribes to /emergency_stop, shares what it hears, and remembers it.

    There are two subscriptions: the latched one receives a stop from before this node, but ROS does
    not match it with a volatile publisher such as `ros2 topic pub`, which must stop the robot too.
    Messages from before can only stop: with two publishers, one may have released a stop long
    before the other sent the current one, and their messages arrive in any order. A release that is
    said now counts by either: of a publisher that lives for 0.1 s, such as `ros2 topic pub --once`,
    often one of them alone hears.
    """

    def __init__(
        self, node: LessonNode, changed: Callable[[bool], None], released: Callable[[], None] | None = None
    ) -> None:
        """Start with the saved stop, for which `changed` is not called.

        `released` is called at each release, even if this node knows of no stop.
        """
        self._node, self._changed, self._was_released = node, changed, released
        self._began_ns = time.time_ns()
        name = node.get_fully_qualified_name()
        self._file = StopFile(node.context.get_domain_id(), name)
        self._status = DiagnosticStatus(name=name)
        quiet = PublisherEventCallbacks(use_default_callbacks=False)
        self._publisher = node.create_publisher(DiagnosticArray, EMERGENCY_STATE, LATCHED, event_callbacks=quiet)
        self._released_s = self._contradicted_s = self._suspected_s = 0.0
        self._insistence = Insistence()
        self._suspects: set[bytes] = set()
        """Publishers of the topic at the time of the stop whose names are not known yet."""
        self._watch = StopWatch(node, self._file, self._look_around)
        self._known = KnownStops()
        saved = self._file.read()
        self._known.learn(saved.record, saved.written_ns)
        self._stop = saved.stop
        if self._stop is not None:
            self._tell_remembered(self._stop)
        self._publish()
        # With what the middleware says of a message, of which the types of rclpy do not know.
        hear_old: Any = self._hear_old
        hear: Any = self._hear
        node.create_subscription(Bool, EMERGENCY_STOP, hear_old, LATCHED)
        node.create_subscription(Bool, EMERGENCY_STOP, hear, DEPTH)
        node.create_subscription(DiagnosticArray, EMERGENCY_STATE, self._hear_of, OF_MANY)
        node.every(_TOLD_EVERY_S, self._repeat)
        self._watch.start()

    @property
    def active(self) -> bool:
        """Whether nothing may move."""
        return self._stop is not None

    def engage(self, by: str) -> None:
        """Stop until released, whatever the cause; call this on the node's own thread."""
        if self._stop is None:
            now_ns = time.time_ns()
            self._take(StopRecord().stopped(Stop(now_ns)), KeptStop(time.time(), by), now_ns)

    @property
    def _record(self) -> StopRecord:
        return self._known.record

    # ---------------------------------------------------------------- what comes in

    def _hear_old(self, message: Bool, info: dict[str, Any]) -> None:
        if message.data:
            self._hear_stop(info)
        elif self._is_said_now(info):
            self._hear_release(info)

    def _is_said_now(self, info: dict[str, Any]) -> bool:
        """Whether a release was said since this node obeys the stop, and just now, by our clock."""
        if self._stop is None:
            return False
        # Not by its arrival, as `named` has it: an old one, too, may arrive now.
        said_ns, now_ns = info.get("source_timestamp") or 0, time.time_ns()
        since_ns = max(self._began_ns, int(self._stop.since_s * 1e9))
        return since_ns < said_ns and 0 <= now_ns - said_ns < _JUST_NOW_NS

    def _hear(self, message: Bool, info: dict[str, Any]) -> None:
        if message.data:
            self._hear_stop(info)
        else:
            self._hear_release(info)

    def _hear_stop(self, info: dict[str, Any]) -> None:
        stop, now_s = named(info), time.monotonic()
        was_free, before = self._stop is None, self._record
        self._insistence.hear([stop], now_s)
        self._take(StopRecord().stopped(stop), KeptStop(time.time(), TOPIC), _heard_ns(info))
        is_news = self._record != before
        if is_news and self._stop is not None and (was_free or now_s > self._suspected_s + 1.0):
            self._suspected_s = now_s
            self._suspects = {bytes(one.endpoint_gid) for one in self._publishers()}
            self._name_suspects()
            self._watch.call_later(_AGAIN_S)

    def _hear_release(self, info: dict[str, Any]) -> None:
        said, was_frozen = named(info), self._watch.was_frozen
        if self._insistence.lasts(time.monotonic(), said.number):
            self._tell_contradicted()
            return
        release, before, saved = (Heard(said.said_ns, _heard_ns(info)), self._record, self._file.read())
        self._known.learn(saved.record, saved.written_ns)
        is_placed = self._known.release(release, was_frozen=was_frozen)
        self._obey(before, saved.stop)
        if not is_placed and self._stop is not None:
            self._node.say.warn(_UNPLACED, every_s=1.0, seconds=release.age_ns / 1e9)
        # A stop that came after the release holds: nothing else may be released then.
        if is_placed and self._stop is None and self._was_released is not None:
            self._was_released()

    def _hear_of(self, message: DiagnosticArray) -> None:
        """Take in what another node obeys, and tell it if that is not all."""
        for report in read_reports(message):
            if report.node == self._status.name:
                continue
            self._take(report.record, report.stop, time.time_ns())
            if report.stop is not None and report.record.held & self._record.held:
                self._name(report.stop.publishers.split())
            if not report.is_of_old and self._record != report.record:
                self._watch.call_later(_AGAIN_S)

    def _look_around(self, *, whole: bool = False) -> None:
        """Take in what the disk says, and save and tell what this node knows."""
        saved = self._file.read()
        self._take(saved.record, saved.stop, saved.written_ns)
        self._save(whole=whole)
        self._publish()

    def _take(self, record: StopRecord, stop: KeptStop | None, seen_ns: int) -> None:
        """Obey what is known now; `stop` says where it is known from, and `seen_ns` since when."""
        before = self._record
        self._known.learn(record, seen_ns)
        self._obey(before, stop)

    def _obey(self, before: StopRecord, stop: KeptStop | None) -> None:
        freed = self._stop is not None and not self._record.engaged
        if freed and self._insistence.lasts(time.monotonic()):
            # By another node, or on disk, where nobody has heard who goes on saying stop.
            now_ns = time.time_ns()
            self._known.learn(StopRecord().stopped(Stop(now_ns)), now_ns)
            self._tell_contradicted()
        record = self._record
        if record == before:
            return
        if record.engaged == (self._stop is not None):
            if self._stop is not None and self._stop.unreadable and stop and not stop.unreadable:
                # Of this one more is known, so that it can be saved.
                self._stop = stop
            self._watch.call_later(_AGAIN_S)
            return
        if record.engaged:
            stop = stop or KeptStop(time.time(), "")
            self._stop = stop._replace(since_s=time.time(), remembered=False)
        else:
            self._stop, self._suspects = None, set()
            self._released_s, self._contradicted_s = time.time(), 0.0
        self._changed(record.engaged)
        self._publish()
        self._save()
        if self._stop is not None and self._stop.unreadable:
            self._tell_remembered(self._stop)

    # ---------------------------------------------------------------- what goes out

    def _repeat(self) -> None:
        if self._stop is not None and self._suspects:
            self._name_suspects()
        self._look_around(whole=True)

    def _name_suspects(self) -> None:
        """Report who may have sent it; the name of a new publisher is known a little later."""
        names, unnamed = set(), set()
        for one in self._publishers():
            gid = bytes(one.endpoint_gid)
            if gid in self._suspects and _UNKNOWN in one.node_name:
                unnamed.add(gid)
            elif gid in self._suspects:
                names.add(f"{one.node_namespace.rstrip('/')}/{one.node_name}")
        self._suspects = unnamed
        self._name(names)

    def _name(self, names: Iterable[str]) -> None:
        """Add to those who may have sent it."""
        if self._stop is not None:
            known = sorted({*self._stop.publishers.split(), *names})[:_MOST_NAMES]
            self._stop = self._stop._replace(publishers=" ".join(known))

    def _publishers(self) -> list[TopicEndpointInfo]:
        return list(self._node.get_publishers_info_by_topic(EMERGENCY_STOP))

    def _save(self, *, whole: bool = True) -> None:
        if self._stop is None:
            problem = self._file.forget(self._record) if self._record.released else ""
            if problem:
                self._node.say.error(_NOT_FORGOTTEN, every_s=10.0, problem=problem)
        elif not self._stop.unreadable:
            problem = self._file.keep(self._stop, self._record, whole=whole)
            if problem:
                self._node.say.error(_NOT_KEPT, every_s=10.0, problem=problem)

    def _tell_contradicted(self) -> None:
        self._contradicted_s = time.monotonic()
        names = "" if self._stop is None else self._stop.publishers.replace(" ", ", ")
        self._node.say.error(_CONTRADICTED, every_s=10.0, publishers=names or "?")
        self._watch.call_later(_AGAIN_S)

    def _tell_remembered(self, stop: KeptStop) -> None:
        if stop.unreadable:
            self._node.say.error(_UNREADABLE, problem=stop.unreadable)
        else:
            at = time.strftime("%Y-%m-%d %H:%M:%S", time.localtime(stop.since_s))
            self._node.say.error(_REMEMBERED, at=at)

    def _publish(self) -> None:
        self._status.message = self._node.say.text(FREE if self._stop is None else HELD)
        said_s = time.monotonic() - self._contradicted_s
        contradicted = bool(self._contradicted_s) and said_s < _CONTRADICTED_S
        message = report_message(self._status, self._record, self._stop, self._released_s, contradicted=contradicted)
        message.header.stamp = self._node.get_clock().now().to_msg()
        self._publisher.publish(message)


def _heard_ns(info: dict[str, Any]) -> int:
    """Return when a message arrived, even if this node was busy then; now if nobody says it."""
    now_ns = time.time_ns()
    return min(info.get("received_timestamp") or now_ns, now_ns)
