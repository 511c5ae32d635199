"""The base of every lesson node: a ROS node with described parameters and translated logs.

A node declares its parameters as attributes of its class, which are their values on the node. ROS gets
descriptors with ranges from them, and an invalid value is refused at the start and at run time, with a
sentence that names the fix. Written by hand, as pydantic would take a third of the time that a node needs to start.
"""

from __future__ import annotations

import inspect
import sys
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar, Generic, TypeVar, overload

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor, SetParametersResult
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.event_handler import PublisherEventCallbacks, QoSRequestedIncompatibleQoSInfo, SubscriptionEventCallbacks
from rclpy.impl.rcutils_logger import RcutilsLogger
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.publisher import Publisher
from rclpy.qos import DurabilityPolicy, QoSPolicyKind, QoSProfile, ReliabilityPolicy
from rclpy.subscription import Subscription
from rclpy.timer import Timer

from text.i18n import N_, detect, localized
from text.plain import plain
from text.sentences import say
from text.suggestions import nearest

DEPTH = 10
"""Queue of an ordinary topic, as everywhere in the course."""
NEWEST = QoSProfile(depth=1, reliability=ReliabilityPolicy.RELIABLE)
"""Queue for subscribers that want only the latest message."""
NEWEST_OF_ANY = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
"""The latest message, from reliable and best-effort publishers alike."""
LATCHED = QoSProfile(depth=1, reliability=ReliabilityPolicy.RELIABLE, durability=DurabilityPolicy.TRANSIENT_LOCAL)
"""A late subscriber gets the last message."""
LONGEST = 400
"""Maximum characters of a log message; the rest is cut off."""

T = TypeVar("T")

_BAD_VALUE = N_("parameter {name} is {value!r}, but must be {expected}; for example: -p {name}:={example}")
_UNKNOWN_NEAR = N_("there is no parameter {name}; did you mean {near}?")
_UNKNOWN = N_("there is no parameter {name}; there are: {known}")
_OWN_TO_ROS = ("use_sim_time", "start_type_description_service", "qos_overrides.")
"""Prefixes of names that rclpy handles by itself."""


class PhrasedError(Exception):
    """An error that can be told in several languages, by its phrase and what fills it."""

    def __init__(self, phrase: str, **values: object) -> None:
        super().__init__(say(phrase, **values))
        self.phrase, self.values = phrase, values


class NodeUsageError(PhrasedError):
    """The node cannot start with these arguments; its code is not at fault."""


class BadValueError(PhrasedError, ValueError):
    """A value that a parameter does not accept; the phrase, what it does accept, follows "but must be"."""


# -------------------------------------------------------------------- parameters


@dataclass
class Setting(Generic[T]):
    """One parameter of a node; its name is that of the attribute, without a `_` at the end."""

    default: T
    about: str
    fixed: bool = field(default=False, kw_only=True)
    """Whether it can be set only at the start."""
    kind: ClassVar[Parameter.Type] = Parameter.Type.STRING
    """The type that ROS shows."""

    def __set_name__(self, _node: type, name: str) -> None:
        self.name = name.rstrip("_")

    @overload
    def __get__(self, node: None, _type: type) -> Setting[T]: ...
    @overload
    def __get__(self, node: LessonNode, _type: type) -> T: ...
    def __get__(self, node: LessonNode | None, _type: type) -> Setting[T] | T:
        return self if node is None else node.values[self.name]

    def accept(self, value: object) -> T:
        """Return the value as this parameter stores it; raises `BadValueError`."""
        raise NotImplementedError

    def expected(self) -> str:
        """Describe the accepted values in a few words, for the help."""
        raise NotImplementedError

    def descriptor(self) -> ParameterDescriptor:
        """Return its descriptor for ROS tools."""
        return ParameterDescriptor(
            name=self.name,
            type=self.kind.value,
            description=self.about,
            read_only=self.fixed,
            additional_constraints=self.expected(),
        )


@dataclass
class Number(Setting[float]):
    """A quantity with a range; integers are accepted too."""

    low: float = field(default=0.0, kw_only=True)
    high: float = field(kw_only=True)
    unit: str = field(default="", kw_only=True)
    kind = Parameter.Type.DOUBLE

    def accept(self, value: object) -> float:
        # Written so that nan is refused.
        if isinstance(value, (int, float)) and not isinstance(value, bool) and self.low <= value <= self.high:
            return float(value)
        raise BadValueError(
            # As a user types them.
            N_("a number from {low} to {high} {unit}"),
            low=f"{self.low:g}",
            high=f"{self.high:g}",
            unit=self.unit,
        )

    def expected(self) -> str:
        return f"{self.low:g} .. {self.high:g} {self.unit}".rstrip()

    def descriptor(self) -> ParameterDescriptor:
        """Return a descriptor with a floating-point range."""
        descriptor = super().descriptor()
        descriptor.floating_point_range = [FloatingPointRange(from_value=float(self.low), to_value=float(self.high))]
        return descriptor


@dataclass
class Whole(Setting[int]):
    """A whole number with a range."""

    low: int = field(default=0, kw_only=True)
    high: int = field(kw_only=True)
    unit: str = field(default="", kw_only=True)
    kind = Parameter.Type.INTEGER

    def accept(self, value: object) -> int:
        if isinstance(value, int) and not isinstance(value, bool) and self.low <= value <= self.high:
            return value
        phrase = N_("a whole number from {low} to {high} {unit}")
        raise BadValueError(phrase, low=self.low, high=self.high, unit=self.unit)

    def expected(self) -> str:
        return f"{self.low} .. {self.high} {self.unit}".rstrip()

    def descriptor(self) -> ParameterDescriptor:
        """Return a descriptor with an integer range."""
        descriptor = super().descriptor()
        descriptor.integer_range = [IntegerRange(from_value=self.low, to_value=self.high)]
        return descriptor


class Switch(Setting[bool]):
    """A parameter that is true or false."""

    kind = Parameter.Type.BOOL

    def accept(self, value: object) -> bool:
        """Return a bool; accept nothing that is merely similar."""
        if isinstance(value, bool):
            return value
        raise BadValueError(N_("true or false"))

    def expected(self) -> str:
        return N_("true, false")


@dataclass
class Text(Setting[str]):
    """A text, which may be empty only if `may_be_empty`."""

    may_be_empty: bool = field(default=False, kw_only=True)
    or_number: bool = field(default=False, kw_only=True)
    """Whether a whole number without quotes is meant as text, as the number of a device is."""
    form: str = field(default="", kw_only=True)
    """What it looks like, for the help."""

    def accept(self, value: object) -> str:
        if self.or_number and isinstance(value, int) and not isinstance(value, bool) and value >= 0:
            return str(value)
        if isinstance(value, str) and (value.strip() or self.may_be_empty):
            return value
        raise BadValueError(N_("a string (in quotes if it looks like a number)"))

    def expected(self) -> str:
        return self.form or (N_("text, may be empty") if self.may_be_empty else N_("text"))


@dataclass
class Choice(Setting[str]):
    """One of a few words."""

    choices: tuple[str, ...] = field(kw_only=True)

    def accept(self, value: object) -> str:
        """Return one of `choices`."""
        if isinstance(value, str) and value in self.choices:
            return value
        raise BadValueError(N_("one of: {choices}"), choices=self.expected())

    def expected(self) -> str:
        return ", ".join(self.choices)


# -------------------------------------------------------------------- the node


class LessonNode(Node):
    """Base of the lesson nodes; raises `NodeUsageError` for parameters that make no sense."""

    NAME: ClassVar[str]
    """Name in the graph, unless it is remapped."""

    def __init__(self) -> None:
        super().__init__(self.NAME, automatically_declare_parameters_from_overrides=True, enable_logger_service=True)
        logger = self.get_logger()  # type: ignore[no-untyped-call]
        self.say = TranslatedLogger(logger, detect())
        self._settings = self.settings()
        self.values: dict[str, Any] = {}
        """The values of its parameters."""
        self._declare()
        self.add_pre_set_parameters_callback(self._with_points)
        self.add_on_set_parameters_callback(self._check)
        self.add_post_set_parameters_callback(self._take)

    @classmethod
    def settings(cls) -> dict[str, Setting[Any]]:
        """Return its parameters by name, in the order of their declaration."""
        declared = (one for base in reversed(cls.__mro__) for one in vars(base).values() if isinstance(one, Setting))
        return {setting.name: setting for setting in declared}

    def contradiction(self, _values: Mapping[str, Any]) -> str | None:
        """Return what is wrong with this combination of values, None if nothing is."""
        return None

    def parameters_changed(self) -> None:
        """Called after new values have been accepted at run time."""

    def every(self, period_s: float, callback: Callable[[], None]) -> Timer:
        """Call back on a clock that never jumps: a Pi sets its clock when it finds a network."""
        return self.create_timer(period_s, callback, clock=Clock(clock_type=ClockType.STEADY_TIME))

    def quick_publisher(self, kind: type, topic: str) -> Publisher:
        """Create a publisher without events for incompatible subscriptions, which report it too.

        A node checks all its event handlers each time it wakes up, which is most of the cost of
        waking up: worthwhile for one that wakes up 20 times a second or more.
        """
        quiet = PublisherEventCallbacks(use_default_callbacks=False)
        return self.create_publisher(kind, topic, DEPTH, event_callbacks=quiet)

    def before_end(self) -> None:
        """Called before the node ends, while the graph can still be used."""

    @classmethod
    def usage(cls) -> str:
        """Return the node's purpose and parameters, for a terminal."""
        module = sys.modules[cls.__module__]
        name = module.__spec__.name if module.__spec__ else cls.__module__
        lines = [inspect.getdoc(module) or "", "", f"python -m {name} --ros-args -p NAME:=VALUE", ""]
        for setting in cls.settings().values():
            lines.append(f"  {setting.name} = {setting.default!r}  ({setting.expected()})")
            lines.append(f"      {setting.about}")
        return "\n".join(lines) + "\n"

    def _declare(self) -> None:
        given = {name: self.get_parameter(name).value for name in self.get_parameters_by_prefix("")}
        for name in given:
            if name not in self._settings and not name.startswith(_OWN_TO_ROS):
                if meant := nearest(name, self._settings):
                    raise NodeUsageError(_UNKNOWN_NEAR, name=name, near=meant)
                raise NodeUsageError(_UNKNOWN, name=name, known=", ".join(self._settings) or "-")
        for name, setting in self._settings.items():
            if name in given:
                self.undeclare_parameter(name)
            value = given.get(name, setting.default)
            try:
                self.values[name] = setting.accept(value)
            except BadValueError as error:
                raise NodeUsageError(_BAD_VALUE, **self._complaint(setting, value, error)) from None
            self.declare_parameter(name, self.values[name], setting.descriptor(), ignore_override=True)
        problem = self.contradiction(self.values)
        if problem is not None:
            raise NodeUsageError(problem, **self.values)

    def _complaint(self, setting: Setting[Any], value: object, error: BadValueError) -> dict[str, object]:
        return {
            "name": setting.name,
            "value": value,
            "expected": self.say.text(error.phrase, **error.values).rstrip(),
            "example": str(setting.default).lower() if isinstance(setting.default, bool) else setting.default,
        }

    def _with_points(self, parameters: Sequence[Parameter]) -> list[Parameter]:
        """Accept `rate:=2` for `rate:=2.0`, about which ROS itself is strict."""
        return [
            Parameter(one.name, Parameter.Type.DOUBLE, float(one.value))
            if one.type_ == Parameter.Type.INTEGER and isinstance(self._settings.get(one.name), Number)
            else one
            for one in parameters
        ]

    def _check(self, parameters: Sequence[Parameter]) -> SetParametersResult:
        wanted = dict(self.values)
        for parameter in parameters:
            setting = self._settings.get(parameter.name)
            if setting is None:
                continue
            try:
                wanted[parameter.name] = setting.accept(parameter.value)
            except BadValueError as error:
                reason = self.say.text(_BAD_VALUE, **self._complaint(setting, parameter.value, error))
                return SetParametersResult(successful=False, reason=reason)
        problem = self.contradiction(wanted)
        if problem is not None:
            return SetParametersResult(successful=False, reason=self.say.text(problem, **wanted))
        return SetParametersResult(successful=True)

    def _take(self, parameters: Sequence[Parameter]) -> None:
        mine = {one.name: one.value for one in parameters if one.name in self._settings}
        self.values.update((name, self._settings[name].accept(value)) for name, value in mine.items())
        if mine:
            self.parameters_changed()


def change_period(timer: Timer, period_s: float) -> None:
    """Change the period of a timer."""
    timer.timer_period_ns = int(period_s * 1e9)
    timer.reset()


class PeriodicThread:
    """Calls back every `period_s` seconds, which may be changed at any time, on a thread of its own.

    That costs less than a node's timer: each round of an executor checks everything a node waits for;
    at 50 Hz that is most of its work.
    """

    def __init__(self, period_s: float, call: Callable[[], None]) -> None:
        self.period_s = period_s
        self._call = call
        self._ending = False
        self._thread = threading.Thread(target=self._live, name="pace", daemon=True)

    def start(self) -> None:
        self._thread.start()

    def close(self) -> None:
        """End the thread, after its current callback."""
        self._ending = True
        if self._thread.is_alive():
            self._thread.join(2 * self.period_s + 0.1)

    def _live(self) -> None:
        due_s = time.monotonic()
        while not self._ending:
            self._call()
            # Missed calls are not made up for.
            due_s = max(due_s + self.period_s, time.monotonic())
            time.sleep(max(0.0, due_s - time.monotonic()))


class SensorListener:
    """Subscribes reliably, or as best effort from the first publisher on that offers no more.

    A best-effort request would match both, but would then lose most large pictures, which travel in
    many fragments, of a reliable publisher. So best effort is requested only if nothing else is
    offered.
    """

    def __init__(
        self,
        node: LessonNode,
        kind: type[Any],
        topic: str,
        hear: Callable[[Any], None],
        *,
        depth: int = DEPTH,
        raw: bool = False,
    ) -> None:
        """`hear` is called with each message, or with its bytes if `raw`."""
        self._node, self._kind, self._topic = node, kind, topic
        self._hear, self._depth, self._raw = hear, depth, raw
        self._relaxed = False
        self._subscription = self._subscribed(
            ReliabilityPolicy.RELIABLE, SubscriptionEventCallbacks(incompatible_qos=self._relax)
        )

    def _subscribed(
        self, reliability: ReliabilityPolicy, events: SubscriptionEventCallbacks | None = None
    ) -> Subscription:
        return self._node.create_subscription(
            self._kind,
            self._topic,
            self._hear,
            QoSProfile(depth=self._depth, reliability=reliability),
            event_callbacks=events,
            raw=self._raw,
        )

    def _relax(self, told: QoSRequestedIncompatibleQoSInfo) -> None:
        if self._relaxed or told.last_policy_kind != QoSPolicyKind.RELIABILITY:
            return
        self._relaxed = True
        strict, self._subscription = (self._subscription, self._subscribed(ReliabilityPolicy.BEST_EFFORT))
        self._node.destroy_subscription(strict)


# -------------------------------------------------------------------- its log


def printable(text: str) -> str:
    """Make it a single line without control characters, cut to length."""
    clean = plain(text)
    return clean if len(clean) <= LONGEST else clean[: LONGEST - 1] + "…"


class TranslatedLogger:
    """Logs phrases in one language, one line per message, whatever its values.

    The phrases are English in the code, marked by `N_`, and Russian in the catalogue.
    """

    def __init__(self, logger: RcutilsLogger, language: str) -> None:
        self._logger = logger
        self.language = language
        self._said_s: dict[str, float] = {}

    def text(self, phrase: str, **values: object) -> str:
        """Return the phrase in this language, printable."""
        return printable(localized(say(phrase, **values), self.language))

    # One line per severity: rclpy remembers the severity for each logging line of code.

    def info(self, phrase: str, *, every_s: float = 0.0, **values: object) -> None:
        """Log; not more often than every `every_s` seconds."""
        if self._is_due(phrase, every_s):
            self._logger.info(self.text(phrase, **values))

    def warn(self, phrase: str, *, every_s: float = 0.0, **values: object) -> bool:
        """Log a warning; not more often than every `every_s` seconds. Return whether it was."""
        if is_due := self._is_due(phrase, every_s):
            self._logger.warning(self.text(phrase, **values))
        return is_due

    def error(self, phrase: str, *, every_s: float = 0.0, **values: object) -> None:
        """Log an error; not more often than every `every_s` seconds."""
        if self._is_due(phrase, every_s):
            self._logger.error(self.text(phrase, **values))

    def fatal(self, phrase: str, **values: object) -> None:
        """Log why the node cannot go on."""
        self._logger.fatal(self.text(phrase, **values))

    def _is_due(self, phrase: str, every_s: float) -> bool:
        now_s = time.monotonic()
        if every_s and now_s - self._said_s.get(phrase, -every_s) < every_s:
            return False
        self._said_s[phrase] = now_s
        return True
