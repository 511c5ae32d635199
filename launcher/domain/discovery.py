"""Who can discover a session's nodes: with `localhost` only this machine, and quickly.

ROS's own discovery range LOCALHOST only keeps nodes from looking for others: their sockets stay
open to every network, and anybody who names this machine as a peer gets in. So Deck's Fast DDS
settings bind them to the loopback interface, and the range leaves all else to them. None of Deck's
nodes uses shared memory, wherever others may find it: what a killed process leaves there makes
others hang.

A Fast DDS participant announces itself before it listens, so the answers of existing participants
are lost, and it learns of each one only at its next regular announcement: every 3 s by default,
here every 0.2 s (measured with eight nodes: 0.5 s instead of 2.9 s, for 0.5 % of a core), and every
0.05 s in the first 2 s of a process. This applies to a single machine only: on a wireless network
the announcements of a whole class would add up.
"""

from __future__ import annotations

from collections.abc import Mapping, MutableMapping
from pathlib import Path

from text.sentences import Words, say

PROFILES = Path(__file__).resolve().parents[2] / "graph" / "fastdds.xml"
OF_PEERS = PROFILES.with_name("fastdds_peers.xml")

VARIABLES = ("FASTDDS_DEFAULT_PROFILES_FILE", "FASTRTPS_DEFAULT_PROFILES_FILE")
"""The current name and the older one; if the user has set either, it is left alone."""

ONLY_THESE = "SKIP_DEFAULT_XML_FILE"
"""Keeps Fast DDS from reading DEFAULT_FASTRTPS_PROFILES.xml in the current folder as well."""

RANGE = "ROS_AUTOMATIC_DISCOVERY_RANGE"
TRANSPORTS = "FASTDDS_BUILTIN_TRANSPORTS"
"""What Fast DDS uses where no file says it; a user's own choice stays."""

RMW, FAST_RTPS = "RMW_IMPLEMENTATION", ("", "rmw_fastrtps_cpp", "rmw_fastrtps_dynamic_cpp")


def settings_of_discovery(environ: Mapping[str, str], discovery: str | tuple[str, ...]) -> dict[str, str | None]:
    """Return the variables to set for fast discovery that is limited to this machine.

    Args:
        environ: the variables already set, perhaps by this function
        discovery: as in a profile

    Returns:
        Names and values; None unsets.
    """
    if _chosen_by_user(environ) or environ.get(RMW, "") not in FAST_RTPS:
        return {}
    if discovery == "subnet":
        return {**dict.fromkeys((*VARIABLES, ONLY_THESE)), TRANSPORTS: environ.get(TRANSPORTS, "UDPv4")}
    local = discovery == "localhost"
    file = str(PROFILES if local else OF_PEERS)
    return {**dict.fromkeys(VARIABLES, file), ONLY_THESE: "1", RANGE: "SYSTEM_DEFAULT" if local else "SUBNET"}


def why_open(environ: Mapping[str, str], discovery: str | tuple[str, ...]) -> Words | None:
    """Say what keeps Deck from closing a local session to the network; None if nothing."""
    if discovery != "localhost":
        return None
    name = _chosen_by_user(environ)
    if name:
        return say(
            "{name} is set, so Deck's own Fast DDS settings are not used: others on the "
            "network may be able to see and drive this robot",
            name=name,
        )
    if environ.get(RMW, "") not in FAST_RTPS:
        return say(
            "{name}={value}: only with rmw_fastrtps_cpp can Deck promise that nobody on "
            "the network sees or drives this robot",
            name=RMW,
            value=environ[RMW],
        )
    return None


def _chosen_by_user(environ: Mapping[str, str]) -> str:
    ours = ("", str(PROFILES), str(OF_PEERS))
    return next((name for name in VARIABLES if environ.get(name, "") not in ours), "")


def set_discovery(environ: MutableMapping[str, str], discovery: str | tuple[str, ...]) -> None:
    """Apply `settings_of_discovery`; Fast DDS reads them when a process creates its first node."""
    for name, value in settings_of_discovery(environ, discovery).items():
        if value is None:
            environ.pop(name, None)
        else:
            environ[name] = value
