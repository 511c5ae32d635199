"""The base of every lesson node: a ROS node with described parameters and translated logs."""

from __future__ import annotations

import inspect
import sys
from typing import TYPE_CHECKING, ClassVar

from rcl_interfaces.msg import SetParametersResult
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.event_handler import PublisherEventCallbacks
from rclpy.node import Node
from rclpy.parameter import Parameter

from nodes.parts.parameters import BadValueError, Setting, Value
from nodes.parts.qos import DEPTH
from nodes.parts.translated_logger import TranslatedLogger
from text.i18n import N_, detect
from text.sentences import say
from text.suggestions import nearest

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from rclpy.publisher import Publisher
    from rclpy.timer import Timer

_BAD_VALUE = N_("parameter {name} is {value!r}, but must be {expected}; for example: -p {name}:={example}")
_UNKNOWN_NEAR = N_("there is no parameter {name}; did you mean {near}?")
_UNKNOWN = N_("there is no parameter {name}; there are: {known}")
_OWN_TO_ROS = ("use_sim_time", "start_type_description_service", "qos_overrides.")
"""Prefixes of names that rclpy handles by itself."""


class NodeUsageError(Exception):
    """The node cannot start with these arguments; its code is not at fault."""

    def __init__(self, phrase: str, **values: object) -> None:
        super().__init__(say(phrase, **values))
        self.phrase = phrase
        self.values = values


def change_period(timer: Timer, period_s: float) -> None:
    """Change the period of a timer."""
    timer.timer_period_ns = int(period_s * 1e9)
    timer.reset()


class LessonNode(Node):
    """Base of the lesson nodes; raises `NodeUsageError` for parameters that make no sense."""

    NAME: ClassVar[str]
    """Name in the graph, unless it is remapped."""
    SETTINGS: ClassVar[tuple[Setting, ...]] = ()

    def __init__(self) -> None:
        super().__init__(self.NAME, automatically_declare_parameters_from_overrides=True, enable_logger_service=True)
        logger = self.get_logger()  # type: ignore[no-untyped-call]
        self.say = TranslatedLogger(logger, detect())
        self._settings = {setting.name: setting for setting in self.SETTINGS}
        self._values: dict[str, Value] = {}
        self._declare()
        self.add_pre_set_parameters_callback(self._with_points)
        self.add_on_set_parameters_callback(self._check)
        self.add_post_set_parameters_callback(self._take)

    def number(self, name: str) -> float:
        """Current value of a `Number` or a `Whole`."""
        return float(self._values[name])

    def text(self, name: str) -> str:
        """Current value of a `Text` or a `Choice`."""
        return str(self._values[name])

    def switch(self, name: str) -> bool:
        """Current value of a `Switch`."""
        return bool(self._values[name])

    def contradiction(self, _values: Mapping[str, Value]) -> str | None:
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
        for setting in cls.SETTINGS:
            lines.append(f"  {setting.name} = {setting.default!r}  ({setting.expected()})")
            lines.append(f"      {setting.about}")
        return "\n".join(lines) + "\n"

    # ---------------------------------------------------------------- parameters

    def _declare(self) -> None:
        given = {name: self.get_parameter(name).value for name in self.get_parameters_by_prefix("")}
        for name in given:
            if name not in self._settings and not name.startswith(_OWN_TO_ROS):
                raise self._unknown(name)
        for name, setting in self._settings.items():
            if name in given:
                self.undeclare_parameter(name)
            value = given.get(name, setting.default)
            try:
                self._values[name] = setting.accept(value)
            except BadValueError as error:
                raise NodeUsageError(_BAD_VALUE, **self._complaint(setting, value, error)) from None
            self.declare_parameter(name, self._values[name], setting.descriptor(), ignore_override=True)
        problem = self.contradiction(self._values)
        if problem is not None:
            raise NodeUsageError(problem, **self._values)

    def _unknown(self, name: str) -> NodeUsageError:
        if meant := nearest(name, self._settings):
            return NodeUsageError(_UNKNOWN_NEAR, name=name, near=meant)
        return NodeUsageError(_UNKNOWN, name=name, known=", ".join(self._settings) or "-")

    def _complaint(self, setting: Setting, value: object, error: BadValueError) -> dict[str, object]:
        return {
            "name": setting.name,
            "value": value,
            "expected": self.say.text(error.expected, **error.values).rstrip(),
            "example": str(setting.default).lower() if isinstance(setting.default, bool) else setting.default,
        }

    def _with_points(self, parameters: Sequence[Parameter]) -> list[Parameter]:
        """Accept `rate:=2` for `rate:=2.0`, about which ROS itself is strict."""
        return [self._with_point(parameter) for parameter in parameters]

    def _with_point(self, parameter: Parameter) -> Parameter:
        setting = self._settings.get(parameter.name)
        if (
            setting is not None
            and setting.kind == Parameter.Type.DOUBLE
            and parameter.type_ == Parameter.Type.INTEGER
        ):
            return Parameter(parameter.name, Parameter.Type.DOUBLE, float(parameter.value))
        return parameter

    def _check(self, parameters: Sequence[Parameter]) -> SetParametersResult:
        wanted = dict(self._values)
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
        mine = [parameter for parameter in parameters if parameter.name in self._settings]
        for parameter in mine:
            self._values[parameter.name] = self._settings[parameter.name].accept(parameter.value)
        if mine:
            self.parameters_changed()
