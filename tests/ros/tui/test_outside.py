"""Who is outside a session, on a real graph: known by the process, whatever its name."""

from __future__ import annotations

import sys
from functools import partial
from typing import TYPE_CHECKING

import pytest

from launcher.status import Severity
from tests.ros.managed_nodes import started
from tests.ros.observing import Peer
from tests.ros.supervised import running_pid
from tests.waiting import until
from tui.session.outside import Outside

if TYPE_CHECKING:
    from launcher.client.client import SupervisorClient
    from tests.ros.observing import Watcher
    from tests.ros.supervised import Launch

pytestmark = pytest.mark.nightly

OTHER_NAME = [sys.executable, "-m", "nodes.hello", "--ros-args", "-r", "__node:=called_otherwise"]


def outside(watcher: Watcher, client: SupervisorClient) -> tuple[str, ...]:
    found = Outside()
    found.see(watcher.update, client.nodes, client.session.run_id)
    return found.now


async def test_what_others_log_is_heard_by_name_and_level_and_the_level_is_theirs_to_change(
    watcher: Watcher, ros_domain: int
) -> None:
    found, inner = Outside(), watcher.observer.inner
    heard: list[tuple[str, Severity, str]] = []
    """(node, severity, text) of the lines so far."""

    def told(count: int) -> bool:
        found.see(watcher.update, {}, "run")
        lines = found.lines(watcher.samples.get("/rosout", []), {})
        heard.extend((line.node, line.severity, line.text) for line in lines)
        return len(heard) == count

    def change(transition: str) -> None:
        assert inner.change_state("/good", transition).result(30).error == ""

    with started(ros_domain, "good"):
        await until(lambda: watcher.serves("/good/set_logger_levels"), "its services")
        watcher.observer.follow(["/rosout"])
        await until(lambda: (row := watcher.row("/rosout")) and row.measured, "a subscription")
        change("configure")
        await until(lambda: told(1), "a line")
        change("cleanup")
        assert inner.set_logger_level("/good", "error").result(30).level == "error"
        change("configure")
        change("cleanup")
        assert inner.set_logger_level("/good", "debug").result(30).level == "debug"
        change("configure")
        await until(lambda: told(2), "another line, and not that in between")
    assert heard == [("good", Severity.INFO, "configuring")] * 2


def processes(watcher: Watcher, name: str) -> tuple[int, ...]:
    row = watcher.node(name)
    return row.processes if row else ()


async def test_it_is_told_by_the_process_and_not_by_the_name(
    start: Launch, watcher: Watcher, ros_domain: int
) -> None:
    client = await start({"ours": {"run": "nodes.hello"}, "key": {"exec": OTHER_NAME}})
    await running_pid(client, "ours")
    for name in ("/ours", "/called_otherwise"):
        await until(partial(processes, watcher, name), f"{name} and its process")
    assert outside(watcher, client) == ()
    by_hand = [Peer("by_hand", ros_domain), Peer("ours", ros_domain)]
    try:
        await until(
            lambda: outside(watcher, client) == ("/ours", "by_hand"), "a node and a namesake"
        )
    finally:
        for peer in by_hand:
            peer.close()
    await until(lambda: outside(watcher, client) == (), "nobody outside")
    assert watcher.node("/ours")
