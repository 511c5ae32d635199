"""Warm nodes, and when they count as ready: real rclpy, real DDS."""

from __future__ import annotations

import os
import re
import textwrap
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from launcher.processes.members import proportional_memory
from launcher.processes.table import NODE_MARK, RUN_MARK, command_line, processes, read_marks, read_process
from launcher.status import NodeState, Severity
from tests.ros.supervised import SLEEPER, Launch, alive, running_pid, said, until_state
from tests.waiting import until

if TYPE_CHECKING:
    from launcher.client.client import SupervisorClient

TALKER = """
import signal, sys, time
import rclpy
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import String
from example_interfaces.srv import AddTwoInts

def main():
    rclpy.init(args=sys.argv)
    node = rclpy.create_node("talker")
    node.declare_parameter("delay", 0.0)
    time.sleep(node.get_parameter("delay").value)
    node.create_publisher(String, "/said", 1)
    node.create_service(AddTwoInts, "add", lambda request, response: response)
    node.get_logger().info("talking")
    try: rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException): pass
    rclpy.try_shutdown()

if __name__ == "__main__":
    main()
"""

TICKER = """
import sys
import rclpy
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import Float32

rclpy.init(args=sys.argv)
node = rclpy.create_node("ticker")
publisher = node.create_publisher(Float32, "/ticks", 10)
node.create_timer(0.02, lambda: publisher.publish(Float32()))
try: rclpy.spin(node)
except (KeyboardInterrupt, ExternalShutdownException): pass
rclpy.try_shutdown()
"""


def module(folder: Path, name: str, text: str) -> dict[str, Any]:
    """Write a file beside the profile, return a node that runs it."""
    (folder / f"{name}.py").write_text(textwrap.dedent(text), encoding="utf-8")
    return {"run": f"./{name}.py"}


def probes(client: SupervisorClient) -> list[int]:
    return [
        process.pid
        for process in processes()
        if process.parent == client.session.supervisor_pid
        and (read_marks(process.pid) or {}).get(NODE_MARK) == "deck_probe"
    ]


async def test_nodes_become_ready_in_the_order_of_their_needs(start: Launch, tmp_path: Path) -> None:
    """By their name in the graph, a topic's publisher and a service; the probe goes after."""
    talker = module(tmp_path, "talker_module", TALKER)
    client = await start(
        {
            "third": {**talker, "needs": ["second"], "ready": {"service": "add"}},
            "second": {**talker, "needs": ["first"], "ready": {"topic": "said"}},
            "first": talker,
        }
    )
    assert client.nodes["third"].state is NodeState.WAITING
    for name in ("first", "second", "third"):
        await until_state(client, name, NodeState.READY)
    begins = {
        name: next(line for line in await client.history(name, 100) if "started" in line.text)
        for name in client.nodes
    }
    order = sorted(begins, key=lambda name: begins[name].time_s)
    assert order == ["first", "second", "third"]
    talking = next(line for line in await client.history("first", 99) if line.text == "talking")
    assert (talking.logger, talking.severity, talking.source) == ("first", Severity.INFO, "stderr")
    await until(lambda: not probes(client), "the end of the probe")


async def test_a_warm_node_is_a_process_of_its_own_in_every_respect(start: Launch, tmp_path: Path) -> None:
    """Its title, session, parent and marks; and its pages are shared with the others."""
    talker = module(tmp_path, "talker_module", TALKER)
    client = await start({"one": talker, "two": {**talker, "params": {"delay": 0.0}}})
    pids = []
    for name in client.nodes:
        status = await until_state(client, name, NodeState.READY)
        pid = status.pid
        assert pid is not None
        pids.append(pid)
        process = read_process(pid)
        assert process is not None
        assert command_line(pid) == f"deck: {name} (./talker_module.py)"
        assert (process.name, process.parent) == (name, client.session.supervisor_pid)
        assert (process.group, process.session) == (pid, pid)
        marks = read_marks(pid) or {}
        assert (marks[RUN_MARK], marks[NODE_MARK]) == (client.session.run_id, name)
    memory = proportional_memory(pids)
    assert memory is not None
    assert memory < 2 * 40_000_000
    await client.stop("one")
    assert (client.nodes["one"].exit_code, client.nodes["one"].signal) == (0, None)
    assert alive(pids[1])


async def test_a_topic_of_another_type_or_too_seldom_is_not_what_was_promised(start: Launch, tmp_path: Path) -> None:
    """Nodes that await it would never hear a message; the row tells what is there instead."""
    talker = module(tmp_path, "talker_module", TALKER)
    ticker = module(tmp_path, "ticker_module", TICKER)
    client = await start(
        {
            "wrong": {**talker, "ready": {"topic": "/said", "type": "std_msgs/msg/Float32", "within": 3}},
            "right": {**talker, "ready": {"topic": "/said", "type": "std_msgs/msg/String"}},
            "seldom": {**ticker, "ready": {"topic": "/ticks", "rate": 500, "within": 3}},
            "often": {**ticker, "ready": {"topic": "/ticks", "rate": 10}},
        }
    )
    await until_state(client, "right", NodeState.READY)
    await until_state(client, "often", NodeState.READY)
    status = await until_state(client, "wrong", NodeState.RUNNING)
    assert status.detail == (
        "not ready within 3 s: /said is published as std_msgs/msg/String, expected std_msgs/msg/Float32"
    )
    await until_state(client, "seldom", NodeState.RUNNING)
    await until(
        lambda: re.search(r"/ticks arrives at [1-9]\S* Hz", client.nodes["seldom"].detail),
        "the rate that is measured",
    )
    assert client.nodes["seldom"].detail.endswith("expected 500 Hz")


@pytest.mark.cold
async def test_where_rclpy_is_missing_nodes_run_and_nobody_waits_for_ever(
    start: Launch, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    broken = tmp_path / "broken"
    broken.mkdir()
    (broken / "rclpy.py").write_text("raise ImportError('no rclpy here')")
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([str(broken), *_python_path()]))
    node = module(tmp_path, "plain", "print('running'); import time; time.sleep(1000)")
    client = await start({"node": node, "other": {"exec": SLEEPER, "needs": ["node"]}})
    await said(client, "node", "running")
    status = await until_state(client, "node", NodeState.RUNNING)
    assert status.detail == "whether it is ready cannot be determined"
    await running_pid(client, "other")


def _python_path() -> list[str]:
    before = os.environ.get("PYTHONPATH")
    return [before] if before else []
