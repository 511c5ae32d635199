"""Options that several commands share, and what reads their values, or refuses them with a reason."""

from __future__ import annotations

import argparse
import math
from argparse import ArgumentParser
from collections.abc import Callable

from launcher.domain.domain import parse_domain
from launcher.errors import DomainError
from text.i18n import LANGUAGES, _, localized

MOST_AT_ONCE = 64
LAST_PORT = 65535


def domain(text: str) -> int:
    try:
        return parse_domain(text, "--domain")
    except DomainError as error:
        words = localized(error.args[0]).removeprefix("--domain: ")
        raise argparse.ArgumentTypeError(words) from error


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return math.nan


def seconds(text: str) -> float:
    seconds = _number(text)
    if not 0 <= seconds < math.inf:
        raise argparse.ArgumentTypeError(_("{text!r} is not a number of seconds").format(text=text))
    return seconds


def rate(text: str) -> float:
    """Return the speed of a replay, relative to the original, 0.1 to 10."""
    rate = _number(text)
    if not 0.1 <= rate <= 10:
        raise argparse.ArgumentTypeError(_("{text!r} is not a rate; expected 0.1 to 10").format(text=text))
    return rate


def bandwidth(text: str) -> int:
    """Return bytes per second, 0 for no limit: `40` and `40k` are 40 kB/s, `off` is like `0`."""
    number = text.lower().removesuffix("k")
    if number in ("off", "0"):
        return 0
    kilobytes = _number(number)
    if not 1 <= kilobytes < math.inf:
        words = _("{text!r} is not a bandwidth; expected kB/s from 1 up, such as 40, or off")
        raise argparse.ArgumentTypeError(words.format(text=text))
    return round(1000 * kilobytes)


def folder(text: str) -> str:
    if not text:
        raise argparse.ArgumentTypeError(_("the name of a folder is missing"))
    return text


def count(text: str) -> int:
    if not (text.isascii() and text.isdigit()):
        raise argparse.ArgumentTypeError(_("{text!r} is not a number of lines").format(text=text))
    return int(text)


def whole(text: str) -> int:
    if not (text.isascii() and text.isdigit()):
        raise argparse.ArgumentTypeError(_("{text!r} is not a whole number").format(text=text))
    return int(text)


def between(least: int, most: int) -> Callable[[str], int]:
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


def add_profile(parser: ArgumentParser) -> None:
    parser.add_argument("profile", metavar=_("PROFILE"), help=_("name, lesson number or file: 09-brain"))


def add_profile_options(parser: ArgumentParser) -> None:
    """Add what changes a profile: its hardware, its parameters, its domain."""
    parser.add_argument(
        "--hardware",
        choices=("mock", "real"),
        default="mock",
        help=_("which nodes to start: mocks (the default) or those of the real robot"),
    )
    parser.add_argument(
        "--set",
        dest="overrides",
        metavar=_("NODE.PARAM=VALUE"),
        action="append",
        default=[],
        help=_("a parameter of a node, the value as in YAML; may be repeated"),
    )
    add_domain(parser, _("ROS domain, 0 to 232, preferably 1 to 101"))


def add_domain(parser: ArgumentParser, help_text: str) -> None:
    """Add the ROS domain; what it is by default differs."""
    parser.add_argument("--domain", metavar="N", type=domain, help=help_text)


def add_graph(parser: ArgumentParser, help_text: str = "") -> None:
    """Add the ROS domain, and how far to look for nodes: what joins a graph that somebody runs."""
    add_domain(parser, help_text or _("ROS domain; by default that of the running robot"))
    parser.add_argument(
        "--discovery",
        choices=("localhost", "subnet"),
        help=_(
            "look on this machine only, or on the network too; by default as the running robot does, else localhost"
        ),
    )


def add_screen(parser: ArgumentParser) -> None:
    """Add what the screen begins with, and the limit for its pictures."""
    parser.add_argument(
        "--wall",
        action="store_true",
        help=_("begin with the wall: a few panels as large as possible, for a projector"),
    )
    parser.add_argument(
        "--bandwidth",
        metavar="KB",
        type=bandwidth,
        help=_("limit for pictures in the terminal, kB/s, or off; by default 40 over SSH, else off"),
    )
    parser.add_argument(
        "--pixels",
        choices=("auto", "on", "off"),
        help=_(
            "pictures in true pixels: where the terminal has them and no limit is set (auto, the default), "
            "also with a limit, or never"
        ),
    )


def add_json(parser: ArgumentParser) -> None:
    parser.add_argument("--json", action="store_true", help=_("print JSON, for programs"))


def add_language(parser: ArgumentParser) -> None:
    parser.add_argument("--lang", choices=LANGUAGES, help=_("language; by default that of the locale"))


def add_running(parser: ArgumentParser) -> None:
    parser.add_argument("name", nargs="?", metavar=_("NAME"), help=_("name of the profile, if several are running"))


def add_seed(parser: ArgumentParser, words: str = "") -> None:
    """Add the number that draws the values of tasks; `words`: the help, if it is not as usual."""
    parser.add_argument(
        "--seed",
        metavar="N",
        type=whole,
        default=0,
        help=words or _("draw the values from this number; by default another one in each run"),
    )
