"""The ROS domain that a profile runs in, and who can reach it.

ROS 2 derives UDP ports from the domain. Linux gives the ports of domains above 101 to any program
that asks for a free one, so domains 1 to 101 are safe; 232 is the last one that has ports at all
(ROS 2 documentation, "The ROS_DOMAIN_ID").
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import TypeAlias, Union

from launcher.errors import DomainError
from text.sentences import say

Discovery: TypeAlias = Union[str, "tuple[str, ...]"]
"""`localhost`, `subnet`, or the addresses of static peers."""

LAST_DOMAIN = 232
LAST_SAFE_DOMAIN = 101


def default_domain() -> int:
    """Return a domain from 1 to 101 that depends on the user, so that classmates do not meet."""
    return os.getuid() % LAST_SAFE_DOMAIN + 1


def parse_domain(text: str, source: str) -> int:
    """Read a domain given as text; `source` says where it is from: `--domain`, `ROS_DOMAIN_ID`."""
    try:
        domain = int(text, 10)
    except ValueError:
        domain = -1
    if not 0 <= domain <= LAST_DOMAIN:
        raise DomainError(
            say(
                "{source}: {text!r} is not a ROS domain; expected a whole number from 0 "
                "to {last}, preferably 1 to {safe}",
                source=source,
                text=text,
                last=LAST_DOMAIN,
                safe=LAST_SAFE_DOMAIN,
            )
        )
    return domain


def choose_domain(asked: int | None, profile: int | None, environ: Mapping[str, str]) -> int:
    """Choose the domain: the requested one, else the profile's, ROS_DOMAIN_ID, or the user's own.

    Raises:
        DomainError: if the chosen one is out of range.
    """
    if asked is not None:
        return parse_domain(str(asked), "--domain")
    if profile is not None:
        return profile
    if environ.get("ROS_DOMAIN_ID"):
        return parse_domain(environ["ROS_DOMAIN_ID"], "ROS_DOMAIN_ID")
    return default_domain()


def settings_of_domain(domain: int, discovery: Discovery) -> dict[str, str | None]:
    """Return the variables from which rcl takes its domain and peers; None unsets."""
    return {
        "ROS_DOMAIN_ID": str(domain),
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET" if discovery == "subnet" else "LOCALHOST",
        "ROS_STATIC_PEERS": None if isinstance(discovery, str) else ";".join(discovery),
        # Deprecated, and would take precedence.
        "ROS_LOCALHOST_ONLY": None,
    }
