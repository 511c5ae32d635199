"""Which ROS domain a profile runs in, and who may hear it.

ROS 2 derives UDP ports from the domain. Linux hands the ports of domains above 101 out to
whatever program asks for one, so 1 to 101 are the safe ones, and 232 is the last that has ports
at all (ROS 2 documentation, "The ROS_DOMAIN_ID").
"""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, TypeAlias, Union

from launcher.errors import DomainError
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Mapping

Discovery: TypeAlias = Union[str, "tuple[str, ...]"]
"""`localhost`, `subnet`, or the addresses of static peers."""

LAST_DOMAIN = 232
LAST_SAFE_DOMAIN = 101


def default_domain() -> int:
    """Return a domain from 1 to 101 of the user's own, so that classmates do not meet."""
    return os.getuid() % LAST_SAFE_DOMAIN + 1


def parse_domain(text: str, source: str) -> int:
    """Read a domain given as text; `source` says where from: `--domain`, `ROS_DOMAIN_ID`."""
    try:
        domain = int(text, 10)
    except ValueError:
        domain = -1
    if not 0 <= domain <= LAST_DOMAIN:
        raise DomainError(
            say(
                "{source}: {text!r} is not a ROS domain; expected a whole number from 0 to "
                "{last}, best 1 to {safe}",
                source=source,
                text=text,
                last=LAST_DOMAIN,
                safe=LAST_SAFE_DOMAIN,
            )
        )
    return domain


def choose_domain(asked: int | None, profile: int | None, environ: Mapping[str, str]) -> int:
    """Choose: what was asked for, else the profile's, else ROS_DOMAIN_ID, else the user's own.

    Raises:
        DomainError: if the one that counts is out of range.
    """
    if asked is not None:
        return parse_domain(str(asked), "--domain")
    if profile is not None:
        return profile
    if environ.get("ROS_DOMAIN_ID"):
        return parse_domain(environ["ROS_DOMAIN_ID"], "ROS_DOMAIN_ID")
    return default_domain()


def ros_environment(base: Mapping[str, str], domain: int, discovery: Discovery) -> dict[str, str]:
    """Return `base` with the variables set by which rcl chooses its domain and its peers.

    The deprecated ROS_LOCALHOST_ONLY would win over them, so it goes. Settings of Fast DDS that
    somebody has chosen himself stay.
    """
    environ = dict(base)
    environ.pop("ROS_LOCALHOST_ONLY", None)
    environ.pop("ROS_STATIC_PEERS", None)
    environ["ROS_DOMAIN_ID"] = str(domain)
    environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "SUBNET" if discovery == "subnet" else "LOCALHOST"
    if not isinstance(discovery, str):
        environ["ROS_STATIC_PEERS"] = ";".join(discovery)
    return environ
