"""Parsing the values of options, or refusing them with a reason."""

from __future__ import annotations

import argparse
import math
from typing import TYPE_CHECKING

from launcher.domain.domain import parse_domain
from launcher.errors import DomainError
from text.i18n import _, localized

if TYPE_CHECKING:
    from collections.abc import Callable

MOST_AT_ONCE = 64
LAST_PORT = 65535


def domain(text: str) -> int:
    """Return a ROS domain, 0 to 232."""
    try:
        return parse_domain(text, "--domain")
    except DomainError as error:
        words = localized(error.args[0]).removeprefix("--domain: ")
        raise argparse.ArgumentTypeError(words) from error


def seconds(text: str) -> float:
    """Return seconds, at least 0."""
    try:
        seconds = float(text)
    except ValueError:
        seconds = math.nan
    if not 0 <= seconds < math.inf:
        raise argparse.ArgumentTypeError(_("{text!r} is not a number of seconds").format(text=text))
    return seconds


def rate(text: str) -> float:
    """Return the speed of a replay, relative to the original, 0.1 to 10."""
    try:
        rate = float(text)
    except ValueError:
        rate = math.nan
    if not 0.1 <= rate <= 10:
        raise argparse.ArgumentTypeError(_("{text!r} is not a rate; expected 0.1 to 10").format(text=text))
    return rate


def bandwidth(text: str) -> int:
    """Return bytes per second, 0 for no limit: `40` and `40k` are 40 kB/s, `off` is like `0`."""
    number = text.lower().removesuffix("k")
    if number in ("off", "0"):
        return 0
    try:
        kilobytes = float(number)
    except ValueError:
        kilobytes = math.nan
    if not 1 <= kilobytes < math.inf:
        words = _("{text!r} is not a bandwidth; expected kB/s from 1 up, such as 40, or off")
        raise argparse.ArgumentTypeError(words.format(text=text))
    return round(1000 * kilobytes)


def folder(text: str) -> str:
    """Return the name of a folder, which is not empty."""
    if not text:
        raise argparse.ArgumentTypeError(_("the name of a folder is missing"))
    return text


def count(text: str) -> int:
    """Return a number of lines."""
    if not (text.isascii() and text.isdigit()):
        raise argparse.ArgumentTypeError(_("{text!r} is not a number of lines").format(text=text))
    return int(text)


def whole(text: str) -> int:
    """Return a whole number that is not negative."""
    if not (text.isascii() and text.isdigit()):
        raise argparse.ArgumentTypeError(_("{text!r} is not a whole number").format(text=text))
    return int(text)


def between(least: int, most: int) -> Callable[[str], int]:
    """Return what parses a whole number from `least` to `most`."""

    def parse(text: str) -> int:
        number = whole(text)
        if not least <= number <= most:
            words = _("expected a number from {least} to {most}, got {n}")
            raise argparse.ArgumentTypeError(words.format(least=least, most=most, n=number))
        return number

    return parse


port = between(0, LAST_PORT)
"""Parses a TCP port, 0 for any that is free."""
at_once = between(1, MOST_AT_ONCE)
"""Parses how many runs there may be at once."""
