"""The ROS domain and who can reach it, according to the environment."""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from cli.doctor.finding import fail, ok, warn
from launcher.domain.discovery import RMW, why_open
from launcher.domain.discovery import VARIABLES as FAST_DDS_VARIABLES
from launcher.domain.domain import LAST_SAFE_DOMAIN, choose_domain, default_domain
from launcher.errors import DomainError
from text.i18n import _, localized

if TYPE_CHECKING:
    from collections.abc import Mapping

    from cli.doctor.finding import Finding

VARIABLES = (
    *("ROS_DOMAIN_ID", "ROS_LOCALHOST_ONLY", "ROS_AUTOMATIC_DISCOVERY_RANGE"),
    *("ROS_DISCOVERY_SERVER", "CYCLONEDDS_URI", RMW, *FAST_DDS_VARIABLES),
)


@dataclass(frozen=True)
class NetworkFacts:
    """The environment variables that decide which nodes discover each other."""

    environ: Mapping[str, str] = field(default_factory=dict)
    """Those of VARIABLES that are set."""


def collect() -> NetworkFacts:
    return NetworkFacts({name: os.environ[name] for name in VARIABLES if os.environ.get(name)})


def diagnose(facts: NetworkFacts) -> list[Finding]:
    """Report what is all right and what is not."""
    return [_domain(facts), *_oddities(facts)]


def _domain(facts: NetworkFacts) -> Finding:
    try:
        domain = choose_domain(None, None, facts.environ)
    except DomainError as error:
        return fail("ros.domain", localized(error.args[0]), _("run: unset ROS_DOMAIN_ID"))
    whose = "ROS_DOMAIN_ID" if "ROS_DOMAIN_ID" in facts.environ else _("your own")
    text = _("domain {domain} ({whose}), visible on this machine only unless a profile says otherwise")
    text = text.format(domain=domain, whose=whose)
    if domain > LAST_SAFE_DOMAIN:
        fix = _("export ROS_DOMAIN_ID={domain}: ports of domains above {safe} may be taken")
        return warn("ros.domain", text, fix.format(domain=default_domain(), safe=LAST_SAFE_DOMAIN))
    return ok("ros.domain", text)


def _oddities(facts: NetworkFacts) -> list[Finding]:
    found = []
    if facts.environ.get("ROS_LOCALHOST_ONLY") == "1":
        found.append(
            warn(
                "ros.localhost_only",
                _("ROS_LOCALHOST_ONLY=1 is obsolete and overrides ROS_AUTOMATIC_DISCOVERY_RANGE"),
                _("unset it; Deck does so for its own nodes"),
            )
        )
    for name in ("ROS_DISCOVERY_SERVER", "CYCLONEDDS_URI"):
        if name in facts.environ:
            text = _("{name}={value} changes which nodes see each other").format(name=name, value=facts.environ[name])
            found.append(warn("ros.discovery", text, _("unset it if topics stay empty")))
    open_because = why_open(facts.environ, "localhost")
    if open_because:
        found.append(warn("ros.open", localized(open_because), _("unset it if you do not need it")))
    return found
