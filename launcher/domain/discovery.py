"""Who hears a session's nodes: on `localhost` nobody outside, and they find each other at once.

ROS's own range LOCALHOST only keeps nodes from looking for others: their sockets are open to every
network, and whoever names the machine as his peer is let in. So Deck's settings of Fast DDS bind
them to the loopback interface.

A Fast DDS participant announces itself before it listens, so the answers of those that are there
already are lost, and it knows of each only after that one's next regular announcement: every 3 s
by default, here every 0.2 s (measured with eight nodes: 2.9 s down to 0.5 s, for 0.3 % of a
core), and every 0.05 s in the first 2 s of a process. Only on one machine: on a wireless network
the announcements of a whole class would add up.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Mapping, MutableMapping

    from text.sentences import Words

PROFILES = Path(__file__).resolve().parents[2] / "graph" / "fastdds.xml"

VARIABLES = ("FASTDDS_DEFAULT_PROFILES_FILE", "FASTRTPS_DEFAULT_PROFILES_FILE")
"""Today's name and the one before; whichever the user has set is left alone."""

ONLY_THESE = "SKIP_DEFAULT_XML_FILE"
"""Keeps Fast DDS from reading DEFAULT_FASTRTPS_PROFILES.xml in the current folder as well."""

RMW, FAST_RTPS = "RMW_IMPLEMENTATION", ("", "rmw_fastrtps_cpp", "rmw_fastrtps_dynamic_cpp")


def settings_of_discovery(
    environ: Mapping[str, str], discovery: str | tuple[str, ...]
) -> dict[str, str | None]:
    """Return the variables that differ for who is to be found quickly, and from here alone.

    Args:
        environ: what is set already, perhaps by this function
        discovery: as in a profile; beyond `localhost`, nothing is hurried

    Returns:
        Names and values; None unsets.
    """
    if _chosen_by_user(environ):
        return {}
    if discovery != "localhost":
        return dict.fromkeys((*VARIABLES, ONLY_THESE))
    return {**dict.fromkeys(VARIABLES, str(PROFILES)), ONLY_THESE: "1"}


def why_open(environ: Mapping[str, str], discovery: str | tuple[str, ...]) -> Words | None:
    """Say what keeps Deck from closing a local session to the network; None if nothing does."""
    if discovery != "localhost":
        return None
    name = _chosen_by_user(environ)
    if name:
        return say(
            "{name} is set, so Deck's own settings of Fast DDS are not used: it cannot promise "
            "that nobody on the network hears or drives this robot",
            name=name,
        )
    if environ.get(RMW, "") not in FAST_RTPS:
        return say(
            "{name}={value}: only with rmw_fastrtps_cpp can Deck promise that nobody on the"
            " network hears or drives this robot",
            name=RMW,
            value=environ[RMW],
        )
    return None


def _chosen_by_user(environ: Mapping[str, str]) -> str:
    ours = str(PROFILES)
    return next((name for name in VARIABLES if environ.get(name, ours) not in ("", ours)), "")


def set_discovery(environ: MutableMapping[str, str], discovery: str | tuple[str, ...]) -> None:
    """Set what `settings_of_discovery` says; Fast DDS reads it at a process's first node."""
    for name, value in settings_of_discovery(environ, discovery).items():
        if value is None:
            environ.pop(name, None)
        else:
            environ[name] = value
