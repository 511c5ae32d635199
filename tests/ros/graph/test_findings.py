"""Each finding made true by real nodes, in one domain."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack

import pytest
from builtin_interfaces.msg import Time
from example_interfaces.srv import AddTwoInts
from geometry_msgs.msg import PointStamped, Twist
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Range
from std_msgs.msg import Float32, Header, String
from std_srvs.srv import Trigger

from graph.data import GraphUpdate
from graph.findings.examining import examine
from graph.findings.finding import GraphFinding
from tests.ros.observing import Watcher
from tests.ros.peer import Peer
from tests.waiting import wait_until
from tui.session.norms import NORMS

pytestmark = pytest.mark.nightly

BEST_EFFORT = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)
LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


@pytest.fixture(scope="module")
def ill(module_domain: int) -> Iterator[Watcher]:
    """A domain in which nearly everything is wrong."""
    with ExitStack() as stack:
        watcher = Watcher(module_domain)
        stack.callback(watcher.close)
        watcher.observer.measure(all_topics=True)
        one, other = (stack.enter_context(Peer(module_domain, name)) for name in ("one", "other"))
        for _twin in range(2):
            stack.enter_context(Peer(module_domain, "twin"))
        for peer in (one, other):
            stack.enter_context(peer.saying("/cmd_vel", Twist()))
            stack.enter_context(peer.saying("/sensor/sonar_front", Float32(data=1.0)))
        other.hear("/sensor/sonar_frnt", Float32)
        one.publisher("/chatter", String)
        other.hear("/chatter", Float32)
        one.publisher("/scan", Range, BEST_EFFORT)
        other.hear("/scan", Range, 10)
        one.publisher("/map", String)
        other.hear("/map", String, LATCHED)
        other.hear("/nowhere", String)
        other.hear("/clock", Clock)
        old = PointStamped(header=Header(stamp=Time(sec=42)))
        stack.enter_context(one.saying("/boot", old))
        one.node.create_service(AddTwoInts, "/add", lambda _asked, answer: answer)
        other.node.create_client(Trigger, "/add")
        other.node.create_client(AddTwoInts, "/ad")
        yield watcher


def found(update: GraphUpdate, rule: str, place: str) -> GraphFinding | None:
    return next(
        (one for one in examine(update, NORMS) if (one.rule, one.place.name) == (rule, place)), None
    )


@pytest.mark.parametrize(
    ("rule", "place", "nodes"),
    [
        ("fight", "/cmd_vel", {"/one", "/other"}),
        ("fight", "/sensor/sonar_front", {"/one", "/other"}),
        ("near-name", "/sensor/sonar_frnt", {"/one", "/other"}),
        ("two-types", "/chatter", {"/one", "/other"}),
        ("qos", "/scan", {"/one", "/other"}),
        ("qos", "/map", {"/one", "/other"}),
        ("unfed", "/nowhere", {"/other"}),
        ("no-clock", "/clock", {"/other"}),
        ("clock", "/boot", {"/one"}),
        ("two-types", "/add", {"/one", "/other"}),
        ("unserved", "/ad", {"/other"}),
        ("namesakes", "/twin", {"/twin"}),
    ],
)
def test_it_is_found_where_it_is(ill: Watcher, rule: str, place: str, nodes: set[str]) -> None:
    def there() -> GraphFinding | None:
        one = found(ill.update, rule, place)
        return one if one is not None and set(one.nodes) == nodes else None

    finding = wait_until(there, lambda: f"{rule} at {place} in {examine(ill.update, NORMS)}")
    assert finding.what
    assert finding.mend


def test_nothing_else_is_found_there(ill: Watcher) -> None:
    expected = {
        "clock /boot", "fight /cmd_vel", "fight /sensor/sonar_front", "namesakes /twin",
        "near-name /sensor/sonar_frnt", "no-clock /clock", "qos /map", "qos /scan",
        "two-types /add", "two-types /chatter", "unfed /nowhere", "unserved /ad",
    }  # fmt: skip

    def told() -> set[str]:
        return {f"{one.rule} {one.place.name}" for one in examine(ill.update, NORMS)}

    wait_until(lambda: told() == expected, lambda: f"just these, not {told() ^ expected}")


def test_a_stream_that_stops_is_found(ros_domain: int, watcher: Watcher) -> None:
    watcher.observer.measure(all_topics=True)
    with Peer(ros_domain, "sonar") as peer:
        with peer.saying("/range", Range()):
            watcher.wait_for("/range", lambda row: row.count > 20, "20 messages")
            assert found(watcher.update, "silent", "/range") is None
        finding = wait_until(lambda: found(watcher.update, "silent", "/range"), "silence")
        assert "from /sonar, and then nothing" in finding.what
