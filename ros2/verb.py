"""A verb announces itself: `@verb("topic list", "Output a list", *options)` on the function that does it.

The module of a command is found by its place, `ros2.verbs.topic`, and is imported only when it is called.
Options that several verbs have in common stand here, too, with the real tool's names.
"""

from __future__ import annotations

import argparse
import copy
from typing import TYPE_CHECKING, Any, Final, NamedTuple, TypeAlias

if TYPE_CHECKING:
    from collections.abc import Callable

    from rclpy.qos import QoSProfile

    Part: TypeAlias = Callable[[Any], object]
    """Declares options of a parser, or of a group in one."""
    Main: TypeAlias = Callable[[argparse.Namespace], int | str | None]
    """Returns the exit code, or an error text, which is the exit code 1."""


class UsageError(RuntimeError):
    """What is wrong with the command line has shown only later: the exit code is 2."""


class Verb(NamedTuple):
    """What is announced."""

    summary: str
    parts: tuple[Part, ...]
    main: Main


VERBS: dict[str, Verb] = {}
"""Those of the commands that are imported, by command and verb: `topic list`, or `run` alone."""


def verb(name: str, summary: str, *parts: Part) -> Callable[[Main], Main]:
    """Announce a function as a verb; `parts`: its options, in the order of its help."""

    def announced(main: Main) -> Main:
        VERBS[name] = Verb(summary, parts, main)
        return main

    return announced


def arg(*names: str, **settings: Any) -> Part:  # noqa: ANN401 - as argparse has them
    """Return an option or argument, described as argparse has it."""
    return lambda parser: parser.add_argument(*names, **settings)


def flag(*names: str, help: str = "", **settings: Any) -> Part:  # noqa: A002, ANN401
    """Return an option without a value."""
    return arg(*names, action="store_true", help=help or None, **settings)


def every(*parts: Part) -> Part:
    """Return several options as one part."""

    def declare(parser: Any) -> None:  # noqa: ANN401 - a parser, or a group in one
        for part in parts:
            part(parser)

    return declare


def positive_int(text: str) -> int:
    """Read a number of messages."""
    if not text.isdecimal() or int(text) <= 0:
        raise argparse.ArgumentTypeError("value must be a positive integer")
    return int(text)


def positive_float(text: str) -> float:
    """Read a rate."""
    value = float(text)
    if value <= 0:
        raise ValueError
    return value


ANSWERED_WITHIN_S = 5.0
"""So long may a node that is there take to answer, unless told otherwise."""
OF_GRAPH: Final = flag("--no-daemon", help="There is none here: each command looks at the graph anew")
ANSWERS: Final = arg(
    "--timeout", type=positive_float, metavar="SECONDS",
    help=f"Seconds to wait for the answer of a node (default: {ANSWERED_WITHIN_S:g})",
)  # fmt: skip
"""For how long a verb waits for the answer of a node; the real tool waits for ever."""
TYPES: Final = flag("-t", "--show-types", help="Additionally show the types")


def hidden(kind: str) -> Part:
    """Return `--include-hidden-topics`, or of other things that are not all listed."""
    return flag(f"--include-hidden-{kind}", dest="hidden", help=f"Consider hidden {kind} as well")


PROFILES = ("default", "sensor_data", "services_default", "parameters", "parameter_events", "system_default")
POLICIES = {
    "history": ("keep_last", "keep_all", "system_default"),
    "reliability": ("reliable", "best_effort", "system_default"),
    "durability": ("volatile", "transient_local", "system_default"),
}
QOS: Final = every(
    arg("--qos-profile", choices=PROFILES, help="Quality of service preset profile"),
    arg("--qos-depth", metavar="N", type=positive_int, help="Queue size, in place of the profile's"),
    *(
        arg(f"--qos-{policy}", choices=names, help=f"{policy.title()}, in place of the profile's")
        for policy, names in POLICIES.items()
    ),
)


def chosen_qos(args: argparse.Namespace, usual: Callable[[], QoSProfile]) -> QoSProfile:
    """Return the preset that the options `--qos-...` name, or else what is usual, with the others applied to it."""
    from rclpy import qos

    preset = args.qos_profile
    profile = copy.copy(qos.QoSPresetProfiles.get_from_short_key(preset) if preset else usual())
    if args.qos_depth:
        profile.depth = args.qos_depth
    for policy in POLICIES:
        if value := getattr(args, f"qos_{policy}"):
            setattr(profile, policy, getattr(qos, f"{policy.title()}Policy").get_from_short_key(value))
    return profile
