"""Options that several verbs have in common, with the real tool's names."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Final

from ros2.presence import ANSWERED_WITHIN_S
from ros2.verb import arg, every, flag

if TYPE_CHECKING:
    from rclpy.qos import QoSProfile

    from ros2.verb import Part

PROFILES = (
    "unknown", "system_default", "sensor_data", "services_default", "parameters",
    "parameter_events", "action_status_default", "best_available", "default",
)  # fmt: skip
HISTORIES = ("system_default", "keep_last", "keep_all", "unknown")
RELIABILITIES = ("system_default", "reliable", "best_effort", "unknown", "best_available")
DURABILITIES = ("system_default", "transient_local", "volatile", "unknown", "best_available")
LIVELINESSES = ("system_default", "automatic", "manual_by_topic", "unknown", "best_available")


class UsageError(RuntimeError):
    """What is wrong with the command line has shown only later: the exit code is 2."""


def positive_int(text: str) -> int:
    """Read a number of messages."""
    if not text.isdecimal() or int(text) <= 0:
        raise argparse.ArgumentTypeError("value must be a positive integer")
    return int(text)


def unsigned_int(text: str) -> int:
    """Read a length."""
    if not text.isdecimal():
        raise argparse.ArgumentTypeError("value must be non-negative integer")
    return int(text)


def positive_float(text: str) -> float:
    """Read a rate."""
    value = float(text)
    if value <= 0:
        raise ValueError
    return value


of_node: Final = every(
    arg(
        "--spin-time", type=float,
        help="Spin time in seconds to wait for discovery (only applies when not using an already running daemon)",
    ),
    flag("-s", "--use-sim-time", help="Enable ROS simulation time"),
)  # fmt: skip
"""What a verb with a node of its own takes."""
of_graph: Final = every(of_node, flag("--no-daemon", help="Do not spawn nor use an already running daemon"))
"""What a verb takes that could ask the daemon; here there is none."""
answers: Final = arg(
    "--timeout", type=positive_float, default=ANSWERED_WITHIN_S, metavar="SECONDS",
    help="Seconds to wait for the answer of a node (default: %(default)g)",
)  # fmt: skip
"""For how long a verb waits for the answer of a node; the real tool waits for ever."""
of_node_list: Final = every(
    of_graph,
    flag("-a", "--all", help="Display all nodes even hidden ones"),
    flag("-c", "--count-nodes", help="Only display the number of nodes discovered"),
)


def hidden(kind: str) -> Part:
    """Return `--include-hidden-topics`, or of other things that are not all listed."""
    return flag(f"--include-hidden-{kind}", dest="hidden", help=f"Consider hidden {kind} as well")


def qos(doing: str, default: str) -> Part:
    """Return the options `--qos-...`."""
    over = f"setting to {doing} with (overrides the value of --qos-profile option, default: "
    preset = f"Quality of service preset profile to {doing} with (default: {default})"
    return every(
        arg("--qos-profile", choices=PROFILES, help=preset),
        arg("--qos-depth", metavar="N", type=int, default=-1, help=f"Queue size {over}the profile's)"),
        arg("--qos-history", choices=HISTORIES, help=f"History of samples {over}the profile's)"),
        arg("--qos-reliability", choices=RELIABILITIES, help=f"Reliability {over}the profile's)"),
        arg("--qos-durability", choices=DURABILITIES, help=f"Durability {over}the profile's)"),
        arg("--qos-liveliness", choices=LIVELINESSES, help=f"Liveliness {over}the profile's)"),
        arg(
            "--qos-liveliness-lease-duration-seconds", type=float,
            help=f"Liveliness lease duration {over}the profile's)",
        ),
    )  # fmt: skip


def asks_for_qos(args: argparse.Namespace) -> bool:
    """Return whether one of the options is given."""
    return bool(
        args.qos_profile
        or args.qos_depth >= 0
        or args.qos_history
        or args.qos_reliability
        or args.qos_durability
        or args.qos_liveliness
        or args.qos_liveliness_lease_duration_seconds is not None
    )


def chosen_qos(args: argparse.Namespace, profile: QoSProfile) -> QoSProfile:
    """Apply the options to `profile`, in whose place a preset named by them comes."""
    import copy

    from rclpy import qos as policies
    from rclpy.duration import Duration

    if args.qos_profile:
        profile = policies.QoSPresetProfiles.get_from_short_key(args.qos_profile)
    profile = copy.copy(profile)
    if args.qos_depth >= 0:
        profile.depth = args.qos_depth
    for name in ("history", "reliability", "durability", "liveliness"):
        if value := getattr(args, f"qos_{name}"):
            setattr(profile, name, getattr(policies, f"{name.title()}Policy").get_from_short_key(value))
    if args.qos_durability == "transient_local" and profile.depth == 0:
        profile.depth = 1
    if args.qos_liveliness_lease_duration_seconds is not None:
        seconds = args.qos_liveliness_lease_duration_seconds
        profile.liveliness_lease_duration = Duration(seconds=seconds)
    return profile
