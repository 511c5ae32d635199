"""What a client is told: what there is now, and of a flood the newest with a count."""

from __future__ import annotations

from launcher.control.feed import MAX_LINES, ClientFeed
from launcher.logs.ring import LogRing
from launcher.status import LogLine, NodeState, NodeStatus, Severity


def fill(ring: LogRing, node: str, count: int, time_s: float = 0.0) -> None:
    for _line in range(count):
        ring.append(LogLine(node, ring.last_seq + 1, time_s, Severity.INFO, "x"))


def test_old_lines_are_history_and_no_news() -> None:
    ring = LogRing()
    fill(ring, "sonar", 3)
    assert ClientFeed({"sonar": ring}).log_news() is None


def test_a_flood_of_one_node_skips_none_of_another() -> None:
    rings = {"flood": LogRing(), "sonar": LogRing()}
    feed = ClientFeed(rings)
    fill(rings["flood"], "flood", 5 * MAX_LINES)
    fill(rings["sonar"], "sonar", 3)
    news = feed.log_news()
    assert news is not None
    assert news["skipped"] == {"flood": 4 * MAX_LINES}
    assert len([line for line in news["lines"] if line[0] == "sonar"]) == 3
    assert [line[1] for line in news["lines"] if line[0] == "flood"][-1] == 5 * MAX_LINES
    assert feed.log_news() is None


def test_lines_of_several_nodes_come_in_the_order_of_time_and_of_each_node() -> None:
    rings = {"one": LogRing(), "two": LogRing()}
    feed = ClientFeed(rings)
    for time_s in (5.0, 1.0, 9.0):  # A node may say anything of its time.
        fill(rings["one"], "one", 1, time_s)
    fill(rings["two"], "two", 1, 6.0)
    news = feed.log_news()
    assert news is not None
    assert [line[:2] for line in news["lines"]] == [["one", 1], ["one", 2], ["two", 1], ["one", 3]]


def test_of_many_changes_of_a_node_the_last_is_told() -> None:
    feed = ClientFeed({})
    for _change in range(100):
        feed.status_changed(["sonar"])
    status = NodeStatus("sonar", "nodes.mock_sonar", NodeState.READY)
    news = feed.status_news({"sonar": status})
    assert news is not None
    assert [node["state"] for node in news["nodes"]] == ["ready"]
    assert feed.status_news({"sonar": status}) is None
