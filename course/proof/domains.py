"""ROS domains for runs that nobody is to see: not those of other sessions."""

from __future__ import annotations

import random

from launcher.domain.domain import LAST_SAFE_DOMAIN, default_domain
from launcher.runs.record import supervisors


def unused_domains(count: int) -> list[int]:
    """Return so many domains in which no session of this user runs, nor would by default.

    They are drawn, so that two proofs at the same time hardly ever meet.
    """
    taken = {default_domain(), *(one.domain for one in supervisors())}
    free = [domain for domain in range(1, LAST_SAFE_DOMAIN + 1) if domain not in taken]
    return random.SystemRandom().sample(free, min(count, len(free)))
