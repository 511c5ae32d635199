"""Parameters with descriptions, which refuse invalid values.

A node lists its parameters as data. ROS gets descriptors with ranges from that list, and an invalid
value is refused at the start and at run time, with a sentence that names the fix.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Union

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor
from rclpy.parameter import Parameter

from text.i18n import N_
from text.sentences import say

Value = Union[bool, int, float, str]  # noqa: UP007 - evaluated, and valid in Python 3.10

_KINDS = {
    bool: Parameter.Type.BOOL,
    int: Parameter.Type.INTEGER,
    float: Parameter.Type.DOUBLE,
    str: Parameter.Type.STRING,
}


class BadValueError(ValueError):
    """A value that a parameter does not accept."""

    def __init__(self, expected: str, **values: object) -> None:
        super().__init__(say(expected, **values))
        self.expected = expected
        """A description of valid values, to follow "is X, but must be"."""
        self.values = values


@dataclass(frozen=True)
class Setting:
    """One parameter of a node."""

    name: str
    default: Value
    about: str
    fixed: bool = False
    """Whether it can be set only at the start."""

    @property
    def kind(self) -> Parameter.Type:
        """Return the type that ROS shows."""
        return _KINDS[type(self.default)]

    def accept(self, value: object) -> Value:
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


@dataclass(frozen=True)
class Number(Setting):
    """A quantity with a range; integers are accepted too."""

    low: float = 0.0
    high: float = 0.0
    unit: str = ""

    def accept(self, value: object) -> float:
        """Return a float within the range."""
        if isinstance(value, (int, float)) and not isinstance(value, bool):
            number = float(value)
            # Written so that nan is refused.
            if self.low <= number <= self.high:
                return number
        raise BadValueError(
            N_("a number from {low} to {high} {unit}"),
            # As a user types them.
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


@dataclass(frozen=True)
class Whole(Setting):
    """A whole number with a range."""

    low: int = 0
    high: int = 0
    unit: str = ""

    def accept(self, value: object) -> int:
        """Return an int within the range."""
        if isinstance(value, int) and not isinstance(value, bool) and self.low <= value <= self.high:
            return value
        raise BadValueError(
            N_("a whole number from {low} to {high} {unit}"), low=self.low, high=self.high, unit=self.unit
        )

    def expected(self) -> str:
        return f"{self.low} .. {self.high} {self.unit}".rstrip()

    def descriptor(self) -> ParameterDescriptor:
        """Return a descriptor with an integer range."""
        descriptor = super().descriptor()
        descriptor.integer_range = [IntegerRange(from_value=self.low, to_value=self.high)]
        return descriptor


@dataclass(frozen=True)
class Switch(Setting):
    """A parameter that is true or false."""

    def accept(self, value: object) -> bool:
        """Return a bool; accept nothing that is merely similar."""
        if isinstance(value, bool):
            return value
        raise BadValueError(N_("true or false"))

    def expected(self) -> str:
        """Name the two values."""
        return N_("true, false")


@dataclass(frozen=True)
class Text(Setting):
    """A text, which may be empty only if `may_be_empty`."""

    may_be_empty: bool = False

    def accept(self, value: object) -> str:
        if isinstance(value, str) and (value.strip() or self.may_be_empty):
            return value
        raise BadValueError(N_("a string (in quotes if it looks like a number)"))

    def expected(self) -> str:
        """Say whether it may be empty."""
        return N_("text, may be empty") if self.may_be_empty else N_("text")


@dataclass(frozen=True)
class Choice(Setting):
    """One of a few words."""

    choices: tuple[str, ...] = ()

    def accept(self, value: object) -> str:
        """Return one of `choices`."""
        if isinstance(value, str) and value in self.choices:
            return value
        raise BadValueError(N_("one of: {choices}"), choices=self.expected())

    def expected(self) -> str:
        return ", ".join(self.choices)
