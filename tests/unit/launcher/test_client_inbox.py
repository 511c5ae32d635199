"""What a client has not looked at yet is merged, and so bounded."""

from __future__ import annotations

import pytest

from launcher.client import inbox as client_inbox
from launcher.client.inbox import Inbox
from launcher.events import ClosedEvent, LogEvent, StatusEvent
from launcher.status import LogLine, NodeState, NodeStatus, Severity

MAX_LINES = 1000


async def test_news_that_nobody_takes_are_merged_and_counted(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(client_inbox, "MAX_LINES", MAX_LINES)
    inbox = Inbox()
    for state in (NodeState.STARTING, NodeState.READY):
        inbox.put_nodes([NodeStatus("sonar", "x", state)])
    for number in range(3 * MAX_LINES // 100):
        first = 100 * number + 1
        lines = [LogLine("sonar", first + i, 0.0, Severity.INFO, "x") for i in range(100)]
        inbox.put_lines(lines, {"sonar": 1})
    inbox.close("over")
    status, log, closed = [event async for event in inbox.events()]
    assert isinstance(status, StatusEvent)
    assert [node.state for node in status.nodes] == [NodeState.READY]
    assert isinstance(log, LogEvent)
    assert len(log.lines) == MAX_LINES
    assert log.lines[-1].seq == 3 * MAX_LINES
    assert log.skipped == {"sonar": 2 * MAX_LINES + 3 * MAX_LINES // 100}
    assert closed == ClosedEvent("over")


async def test_the_first_reason_for_the_end_counts() -> None:
    inbox = Inbox()
    inbox.close("stopped")
    inbox.close("the supervisor is gone")
    assert [event async for event in inbox.events()] == [ClosedEvent("stopped")]
