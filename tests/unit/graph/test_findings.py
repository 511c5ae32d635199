"""What is wrong with a graph, who cannot hear whom, and diagnostics."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import pytest

from graph.data import ActionRow, EndpointInfo, GraphUpdate, NodeRow, Sample, ServiceRow, TopicRow, Trouble
from graph.diagnostics import STALE_S, DiagnosticsBook, StatusLevel, tree
from graph.findings.finding import FORGOTTEN_S, SETTLED_S, FindingLevel, GraphFinding, meant
from graph.findings.rules import CHANGING_S, LastingFindings, examine
from graph.messages.types import UnknownTypeError
from graph.observer.taps import structural
from graph.qos import Qos, mismatches, to_be_heard, to_hear
from graph.scan import TopicEnds
from tui.session.bypass import NORMS

FLOAT, STRING, RANGE = "std_msgs/msg/Float32", "std_msgs/msg/String", "sensor_msgs/msg/Range"
ARRAY = "diagnostic_msgs/msg/DiagnosticArray"
DRIVE = "ackermann_msgs/msg/AckermannDriveStamped"


def end(node: str, kind: str = FLOAT, **policies: Any) -> EndpointInfo:
    return EndpointInfo(node, kind, **{"reliability": "reliable", "durability": "volatile", **policies})


def topic(name: str, by: str = "", to: str = "", kind: str = FLOAT, **more: Any) -> TopicRow:
    published = more.pop("published_by", tuple(end(node, kind) for node in by.split()))
    subscribed = more.pop("subscribed_by", tuple(end(node, kind) for node in to.split()))
    kinds = tuple(sorted({one.type_name for one in (*published, *subscribed)})) or (kind,)
    return TopicRow(
        name, kinds, len(published), len(subscribed),
        published_by=published, subscribed_by=subscribed, **more,
    )  # fmt: skip


def found(*topics: TopicRow, **more: Any) -> list[GraphFinding]:
    return list(examine(GraphUpdate(0.0, topics, **more), NORMS))


def only(*topics: TopicRow, **more: Any) -> GraphFinding:
    (one,) = found(*topics, **more)
    return one


FED = topic("/sensor/sonar_front", "/sonar_front", "/safety_stop", measured=True, hz=1.0, lost=0)


def test_a_healthy_graph_has_none() -> None:
    nodes = (
        NodeRow("/brain", clients=("/set_head_position",), processes=(7,)),
        NodeRow("/head", services=("/set_head_position",), processes=(8,)),
        NodeRow("/_ros2cli_9", clients=(), processes=(9,)),
    )
    services = (ServiceRow("/set_head_position", ("a/srv/B",), ("/head",)),)
    actions = (ActionRow("/drive_to_point", ("a/action/B",), ("/head",), ()),)
    rows = (
        FED,
        topic("/emergency_stop", "", "/safety_stop", "std_msgs/msg/Bool"),
        topic("/joint_states", "", "/robot_state_publisher", "sensor_msgs/msg/JointState"),
        topic("/drive", "/ai_driver /llm_parser", "/safety_stop", DRIVE),
        topic("/drive_teleop", "", "/safety_stop", DRIVE),
        topic("/ai_command", "/brain", "", STRING, trouble=Trouble.QUIET, measured=True),
        topic("/diagnostics", "/a /b", "", ARRAY, several_send=True),
        topic("/tf", "/a /b", "", "tf2_msgs/msg/TFMessage", several_send=True),
        topic("/rosout", "/a /b", "", "rcl_interfaces/msg/Log", several_send=True),
        topic("/unheard", "/a"),
        topic("/recorded", "/bag", "", trouble=Trouble.QUIET, steady_hz=9.0, age_s=5.0,
              recorded=True),
    )  # fmt: skip
    assert found(*rows, nodes=nodes, services=services, actions=actions) == []
    assert found() == []


CLOCK = "rosgraph_msgs/msg/Clock"
STAMPED: dict[str, Any] = {"measured": True}
BOOL = "std_msgs/msg/Bool"
LAZY = (end("/camera", reliability="best_effort"),)
LATCHED = (end("/map", durability="transient_local"),)
SILENT = topic("/sensor/sonar_front", "/sonar_front", trouble=Trouble.QUIET, age_s=8.0,
               steady_hz=20.0, measured=True)  # fmt: skip
CALLER = NodeRow("/caller", clients=("/add", "/other/get_parameters"))
MAPPERS = tuple(NodeRow(name, publishes=("/map",)) for name in ("/gazebo", "/nav", "/slam"))
Rows = list[TopicRow]


def two(offered: dict[str, Any], asked: dict[str, Any]) -> Rows:
    """One who publishes and one who hears, by these policies."""
    lidar, nav = (end("/lidar", **offered),), (end("/nav", **asked),)
    return [topic("/scan", published_by=lidar, subscribed_by=nav)]


@pytest.mark.parametrize(
    ("rows", "more", "rule", "level", "nodes", "words"),
    [
        ([topic("/drive", "/ai_driver /llm_parser", kind=DRIVE, several_send=True)], {},
         "fight", "ERROR", "/ai_driver /llm_parser", "/ai_driver, /llm_parser"),
        # Also before anything is sent.
        ([topic("/drive_safe", "/safety_stop /rogue", kind=DRIVE)], {},
         "fight", "ERROR", "/safety_stop /rogue", ""),
        ([topic("/clock", "/gazebo /bag", kind=CLOCK)], {}, "fight", "ERROR", "/bag /gazebo", ""),
        ([topic("/sensor/sonar_front", "/mock_sonar /tof_sonar", several_send=True)], {},
         "fight", "WARNING", "/mock_sonar /tof_sonar", ""),
        ([topic("/chatter", published_by=(end("/talker", STRING),),
                subscribed_by=(end("/listener"),))], {},
         "two-types", "ERROR", "/listener /talker", f"{FLOAT} (/listener), {STRING} (/talker)"),
        ([], {"nodes": (CALLER,), "services": (
            ServiceRow("/add", ("a/srv/Add",), ("/server",), called_as=("a/srv/Sum",)),)},
         "two-types", "ERROR", "/server /caller", "a/srv/Add, a/srv/Sum"),
        (two({"reliability": "best_effort"}, {}), {}, "qos", "ERROR", "/lidar /nav",
         "reliability reliable is asked for, best_effort"),
        (two({}, {"durability": "transient_local"}), {}, "qos", "ERROR", "/lidar /nav",
         "durability transient_local is asked for, volatile"),
        (two({"deadline_s": 2.0}, {"deadline_s": 0.5}), {}, "qos", "ERROR", "/lidar /nav",
         "at least every 0.5 s (deadline), 2 s is offered"),
        (two({}, {"lease_s": 0.5}), {}, "qos", "ERROR", "/lidar /nav",
         "at least every 0.5 s (liveliness lease duration), nothing"),
        ([topic("/image", published_by=LAZY, lost=30, count=70, measured=True)], {},
         "lost", "WARNING", "/camera", "30 of 100"),
        ([topic("/burst", published_by=(end("/b", depth=1),), lost=30, count=70, measured=True)],
         {}, "lost", "WARNING", "/b", "deeper queue than 1"),
        ([topic("/scan", "", "/nav /rviz", RANGE)], {}, "unfed", "WARNING", "/nav /rviz", ""),
        ([FED, topic("/sensor/sonar_frnt", "", "/guard")], {}, "near-name", "ERROR",
         "/guard /sonar_front", "-r /sensor/sonar_frnt:=/sensor/sonar_front"),
        ([FED, topic("/sensor/sonar_frnt", "", "/guard", STRING)], {},
         "unfed", "WARNING", "/guard", ""),
        ([topic("/emergency_stop", "", "/gate", BOOL), topic("/emergency_stpo", "/me", "", BOOL)],
         {}, "near-name", "ERROR", "/me /gate", ""),
        ([], {"nodes": (CALLER,), "services": (ServiceRow("/ad", ("a/srv/Add",), ("/h",)),)},
         "unserved", "ERROR", "/caller", "served is /ad"),
        ([], {"actions": (ActionRow("/go", ("a/action/Go",), (), ("/caller",)),)},
         "unserved", "ERROR", "/caller", ""),
        ([topic("/clock", "", "/nav", CLOCK)], {}, "no-clock", "ERROR", "/nav", ""),
        ([topic("/clock", "/gazebo", "/nav", CLOCK), topic("/map", "/slam")], {"nodes": MAPPERS},
         "clock-mix", "WARNING", "/slam", ""),
        ([topic("/imu", "/imu", clock_off_s=1.7e9, **STAMPED)], {}, "clock", "WARNING", "/imu",
         "19676 days behind"),
        ([topic("/imu", "/imu", clock_off_s=-1200.0, **STAMPED)], {}, "clock", "WARNING", "/imu",
         "20 min ahead"),
        ([topic("/imu", "/imu", latency_s=-2.5, **STAMPED)], {}, "clock", "WARNING", "/imu",
         "2.5 s in the future"),
        ([topic("/imu", "/imu", latency_s=7.0, **STAMPED)], {}, "clock", "WARNING", "/imu",
         "arrive 7.0 s after their stamp"),
        ([SILENT], {}, "silent", "WARNING", "/sonar_front",
         "20.0 Hz from /sonar_front, and then nothing for 8 s"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_found_with_its_nodes(
    rows: Rows, more: dict[str, Any], rule: str, level: str, nodes: str, words: str
) -> None:
    finding = only(*rows, **more)
    assert (finding.rule, finding.level) == (rule, FindingLevel[level])
    assert {*finding.nodes} == {*nodes.split()}
    assert words in f"{finding.what} {finding.mend}"


@pytest.mark.parametrize(
    "rows",
    [
        [topic("/image", published_by=LAZY, lost=19, count=0)],
        [topic("/image", published_by=LAZY, lost=30, count=1000)],
        [topic("/scan", "", "/_deck_recorder_3", RANGE)],
        [topic("/scan", "", "/nav", RANGE, own_publishers=1)],
        [topic("/imu", "/imu", latency_s=-0.05)],
        [topic("/map", published_by=LATCHED, latency_s=300.0)],
        [topic("/clock", "/gazebo", "", CLOCK), topic("/imu", "/imu", clock_off_s=1.7e9)],
        [replace(SILENT, steady_hz=None)],
        [replace(SILENT, name="/drive", type_names=(DRIVE,))],
    ],
)
def test_what_may_be_as_it_is_is_not_told(rows: Rows) -> None:
    assert found(*rows) == []


def test_nodes_with_one_name_are_told_by_their_processes_or_by_what_a_node_has_once(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    here = ["3", "4"]
    monkeypatch.setattr("graph.findings.rules.os.listdir", lambda _path: here)
    twice = topic("/rosout", "/twin /twin /other", kind="rcl_interfaces/msg/Log")
    rows = (NodeRow("/twin", processes=(3,)), NodeRow("/other", processes=(4, 5)), NodeRow("/one"))
    findings = found(twice, nodes=rows)
    assert [one.place.name for one in findings] == ["/other", "/twin"]
    assert {one.rule for one in findings} == {"namesakes"}
    assert {one.settled_s for one in findings} == {FORGOTTEN_S}
    here.append("5")
    assert [one.settled_s for one in found(twice, nodes=rows)] == [SETTLED_S, FORGOTTEN_S], (
        "two that run are not one that was killed, and its successor"
    )


@pytest.mark.parametrize(
    ("name", "other", "same"),
    [
        ("/sensor/sonar_frnt", "/sensor/sonar_front", True),
        ("/sensors/sonar_front", "/sensor/sonar_front", True),
        ("/Scan", "/scan", True),
        ("/sonarfront", "/sonar_front", True),
        ("/scan", "/robot/scan", True),
        ("/sensor/sonar_rear", "/sensor/sonar_front", False),
        ("/sensors/ultrasound/front_left", "/sensors/ultrasound/front_right", False),
        ("/wheel_1", "/wheel_2", False),
        ("/sensor/range1", "/sensor/range2", False),
        ("/drive", "/drive_safe", False),
        ("/drive_action", "/drive_safe", False),
        ("/" + "a" * 100_000, "/" + "b" * 100_000, False),
        ("/", "/scan", False),
    ],
)
def test_which_names_are_taken_for_one(name: str, other: str, same: bool) -> None:
    assert meant(name, [other, name]) == (other if same else "")


TYPO = GraphUpdate(0.0, (FED, topic("/sensor/sonar_frnt", "", "/guard")))


def test_what_holds_for_a_moment_only_is_not_told() -> None:
    lasting = LastingFindings(NORMS)
    lasting.take(TYPO, 10.0)
    assert lasting.told(10.0) == ()
    assert lasting.settles_in_s(11.0) == pytest.approx(3.0)
    # No further update need come.
    assert [one.rule for one in lasting.told(14.0)] == ["near-name"]
    assert lasting.settles_in_s(14.0) is None
    lasting.take(GraphUpdate(1.0, (FED,)), 15.0)
    assert lasting.told(99.0) == ()
    lasting.take(TYPO, 16.0)
    assert lasting.told(17.0) == ()


def changing(lasting: LastingFindings, seconds: int) -> float:
    """Have another node in each second; return when, if at all, the typo was first told."""
    for second in range(seconds):
        lasting.take(replace(TYPO, nodes=(NodeRow(f"/node_{second}"),)), float(second))
        if lasting.told(float(second)):
            return float(second)
    return math.inf


def test_while_nodes_come_and_go_it_is_told_later() -> None:
    """On a slow machine a robot's nodes come one after the other, for longer than 4 s."""
    lasting = LastingFindings(NORMS)
    assert changing(lasting, 10) == math.inf
    assert lasting.told(12.9) == ()
    assert lasting.settles_in_s(12.0) == pytest.approx(1.0)
    assert len(lasting.told(13.0)) == 1
    lasting.take(replace(TYPO, nodes=(NodeRow("/another"),)), 14.0)
    assert len(lasting.told(14.0)) == 1, "what is told stays"
    assert changing(LastingFindings(NORMS), 99) == CHANGING_S


def test_a_node_that_has_ended_for_good_is_told_at_once() -> None:
    lasting = LastingFindings(NORMS)
    lasting.take(GraphUpdate(0.0, (FED,)), 0.0, {"/sonar": "exit code 1"})
    (finding,) = lasting.told(0.0)
    assert (finding.rule, finding.place.name) == ("failed", "/sonar")
    assert finding.what == "It has failed, and is not started again: exit code 1"
    lasting.take(GraphUpdate(0.0, (FED,)), 1.0)
    assert lasting.told(1.0) == ()


def end_troubles(node: str, reliability: str = "reliable", durability: str = "volatile") -> EndpointInfo:
    return EndpointInfo(node, FLOAT, reliability, durability)


BEST_EFFORT = end_troubles("/camera", "best_effort")
LATCHED_MAP = end_troubles("/map", "reliable", "transient_local")
PLAIN = end_troubles("/plain")


@pytest.mark.parametrize(
    ("publishers", "wanted"),
    [
        ([], Qos("reliable", "volatile")),
        ([PLAIN], Qos("reliable", "volatile")),
        ([BEST_EFFORT], Qos("best_effort", "volatile")),
        ([LATCHED_MAP], Qos("reliable", "transient_local")),
        ([LATCHED_MAP, PLAIN], Qos("reliable", "volatile")),
        ([LATCHED_MAP, BEST_EFFORT], Qos("best_effort", "volatile")),
    ],
)
def test_the_request_is_the_strongest_that_all_publishers_meet(publishers: list[EndpointInfo], wanted: Qos) -> None:
    assert to_hear(publishers) == wanted
    ours = EndpointInfo("/deck", FLOAT, wanted.reliability, wanted.durability)
    assert mismatches(publishers, [ours]) == []


@pytest.mark.parametrize("subscribers", [[], [PLAIN], [BEST_EFFORT], [LATCHED_MAP], [LATCHED_MAP, PLAIN]])
def test_the_offer_meets_all_subscribers(subscribers: list[EndpointInfo]) -> None:
    offer = to_be_heard(subscribers)
    ours = EndpointInfo("/deck", FLOAT, offer.reliability, offer.durability)
    assert mismatches([ours], subscribers) == []


def test_a_mismatch_names_both_sides_and_the_ways_out() -> None:
    (found,) = mismatches([BEST_EFFORT, PLAIN], [end_troubles("/vlm")])
    assert found.what == ("/vlm does not hear /camera: reliability reliable is asked for, best_effort is offered.")
    assert found.mend == "Let /camera offer reliable, or let /vlm ask for best_effort."
    (found,) = mismatches([PLAIN], [LATCHED_MAP])
    assert (found.policy, found.publisher, found.subscriber) == ("durability", "/plain", "/map")
    assert (found.offered, found.requested) == ("volatile", "transient_local")


def told(offer: dict[str, Any], request: dict[str, Any]) -> list[tuple[str, str, str]]:
    """Policy, offer and request of each mismatch of one publisher and one subscriber."""
    found = mismatches([replace(end_troubles("/p"), **offer)], [replace(end_troubles("/s"), **request)])
    return [(one.policy, one.offered, one.requested) for one in found]


def test_a_deadline_is_met_by_one_that_is_as_short() -> None:
    assert told({"deadline_s": 0.5}, {"deadline_s": 0.5}) == []
    assert told({"deadline_s": 0.1}, {"deadline_s": 0.5}) == []
    assert told({"deadline_s": 0.1}, {}) == []
    assert told({"deadline_s": 0.5}, {"deadline_s": 0.25}) == [("deadline", "0.5", "0.25")]
    assert told({}, {"deadline_s": 2.0}) == [("deadline", "", "2")]


def test_signs_of_life_are_as_many_and_of_the_kind_that_is_asked_for() -> None:
    assert told({"liveliness": "manual_by_topic"}, {"liveliness": "automatic"}) == []
    assert told({"liveliness": ""}, {"liveliness": "manual_by_topic"}) == []
    assert told({"lease_s": 1.0}, {"lease_s": 1.0}) == []
    assert told({"liveliness": "automatic"}, {"liveliness": "manual_by_topic"}) == [
        ("liveliness", "automatic", "manual_by_topic")
    ]
    assert told({"lease_s": 2.0}, {"lease_s": 1.0}) == [("lease", "2", "1")]


def test_each_trouble_has_its_own_words() -> None:
    nobody = TopicEnds("/t", (FLOAT,), subscribers=(PLAIN,))
    misfit = TopicEnds("/t", (FLOAT,), publishers=(BEST_EFFORT,), subscribers=(PLAIN, end_troubles("/b")))
    fine = TopicEnds("/t", (FLOAT,), publishers=(PLAIN,), subscribers=(PLAIN,))
    unknown = UnknownTypeError("foo_msgs is not installed")
    assert structural(nobody, FLOAT, None) == (Trouble.NO_PUBLISHER, "")
    trouble, detail = structural(misfit, FLOAT, None)
    assert trouble is Trouble.QOS_MISMATCH
    assert detail.endswith("(and 1 more such pairs)")
    assert structural(fine, "foo_msgs/msg/Bar", unknown) == (Trouble.UNKNOWN_TYPE, "foo_msgs is not installed")
    assert structural(fine, FLOAT, None) == (None, "")


OK, WARN, ERROR, STALE = StatusLevel.OK, StatusLevel.WARN, StatusLevel.ERROR, StatusLevel.STALE
T0 = 1_700_000_000.0


def status(name: str, level: Any = 0, message: str = "", **values: Any) -> dict[str, Any]:
    told = [{"key": key, "value": value} for key, value in values.items()]
    return {
        "name": name, "level": level, "message": message, "hardware_id": "", "values": told
    }  # fmt: skip


def said(*told: Any, at_s: float = T0) -> Sample:
    kind = "diagnostic_msgs/msg/DiagnosticArray"
    return Sample("/diagnostics", kind, at_s, 0.0, 100, {"status": list(told)})


def book_of(*told: Any) -> DiagnosticsBook:
    book = DiagnosticsBook()
    book.take([said(*told)])
    return book


def drawn(book: DiagnosticsBook) -> list[str]:
    return [f"{'  ' * row.depth}{row.label} {row.level.name}" for row in tree(book.records)]


def test_what_is_not_repeated_is_stale_until_it_is_heard_again() -> None:
    book = book_of(status("imu", 2, "broken"), status("camera"))
    book.take([said(status("camera"), at_s=T0 + 4)])
    book.look(T0 + STALE_S + 0.1)
    assert drawn(book) == ["imu STALE", "camera OK"]
    record = book.get("imu")
    assert record is not None
    assert record.history[-1] == (T0 + STALE_S + 0.1, STALE, "broken")
    book.look(T0 + STALE_S + 0.2)
    assert len(record.history) == 2
    book.take([said(status("imu", 2, "broken"), at_s=T0 + 6)])
    assert [change.level for change in record.history] == [ERROR, STALE, ERROR]
