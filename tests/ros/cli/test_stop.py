"""`deck stop`: obeyed though nobody hears anybody, and confirmed only by the nodes themselves."""

from __future__ import annotations

import asyncio

from safety.stop_file import StopFile
from tests.deck_process import deck
from tests.ros.node_process import NodeProcess
from tests.ros.supervised import SLEEPER, Launch
from tests.waiting import until

NODE = "nodes.electronic_differential"
DEAF = ("--ros-args", "-r", "/emergency_stop:=/nobody", "-r", "/emergency_stop_state:=/no_state")


async def test_a_stop_is_confirmed_by_those_that_obey_it(start: Launch, ros_domain: int) -> None:
    await start({"node": {"exec": SLEEPER}})
    with NodeProcess(NODE, ros_domain) as node:
        node.wait_for_words("listens to")
        done = await asyncio.to_thread(deck, "stop")
    assert (done.process.returncode, done.lines) == (0, ["obeyed by /electronic_differential"])
    assert "Ctrl+R" in done.errors[0]


async def test_a_stop_that_nobody_confirms_holds_and_is_no_success(start: Launch, ros_domain: int) -> None:
    await start({"node": {"exec": SLEEPER}})
    with NodeProcess(NODE, ros_domain, arguments=DEAF) as node:
        node.wait_for_words("listens to")
        done = await asyncio.to_thread(deck, "stop", "test")
        await until(lambda: "EMERGENCY STOP" in node.output, "the stop")
    assert done.process.returncode == 1
    assert "nobody has confirmed it" in done.errors[-1]
    assert StopFile(ros_domain, "/test").read().record.engaged


def test_without_a_robot_it_is_no_success(ros_domain: int) -> None:
    del ros_domain
    done = deck("stop")
    assert done.process.returncode == 1
    assert "nothing runs" in done.errors[0]
