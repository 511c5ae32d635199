"""Who is in a domain, by the kernel of this machine alone."""

from __future__ import annotations

import os

from graph.data import PROCESS_NUMBERS
from graph.observer.census import living
from tests.ros.observing import Peer
from tests.waiting import wait_until


def test_whoever_listens_in_a_domain_is_found_and_nobody_else(ros_domain: int) -> None:
    assert living(ros_domain) == frozenset()
    peer = Peer("talker", ros_domain)
    assert living(ros_domain) == {peer.process.pid % PROCESS_NUMBERS}
    assert peer.process.pid % PROCESS_NUMBERS not in living(ros_domain + 1)
    assert os.getpid() % PROCESS_NUMBERS not in living(ros_domain)
    peer.close()
    wait_until(lambda: living(ros_domain) == frozenset(), "it has left")
