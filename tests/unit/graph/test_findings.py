"""What is wrong with a graph: each rule on a graph made by hand, and silence on a healthy one."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import pytest

from graph.data import (
    NAMELESS,
    ActionRow,
    EndpointInfo,
    GraphUpdate,
    NodeRow,
    ServiceRow,
    TopicRow,
    Trouble,
)
from graph.findings.examining import examine
from graph.findings.finding import FORGOTTEN_S, SETTLED_S, FindingLevel, GraphFinding
from graph.findings.lasting import CHANGING_S, LastingFindings
from graph.findings.names import meant
from tests.hostile_text import EVIL
from text.i18n import localized
from text.plain import is_plain
from tui.session.norms import NORMS

FLOAT, STRING, RANGE = "std_msgs/msg/Float32", "std_msgs/msg/String", "sensor_msgs/msg/Range"
ARRAY = "diagnostic_msgs/msg/DiagnosticArray"
DRIVE = "ackermann_msgs/msg/AckermannDriveStamped"


def end(node: str, kind: str = FLOAT, **policies: Any) -> EndpointInfo:
    return EndpointInfo(
        node, kind, **{"reliability": "reliable", "durability": "volatile", **policies}
    )


def topic(name: str, by: str = "", to: str = "", kind: str = FLOAT, **more: Any) -> TopicRow:
    """Return a topic with these nodes as publishers and subscribers, all of one type."""
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
              facts={"recorded": ""}),
    )  # fmt: skip
    assert found(*rows, nodes=nodes, services=services, actions=actions) == []
    assert found() == []


def test_two_who_command_at_once_fight() -> None:
    finding = only(topic("/drive", "/ai_driver /llm_parser", kind=DRIVE, several_send=True))
    assert (finding.level, finding.rule) == (FindingLevel.ERROR, "fight")
    assert finding.place == ("topic", "/drive")
    assert finding.nodes == ("/ai_driver", "/llm_parser")
    assert "/ai_driver, /llm_parser" in finding.what


def test_what_only_one_may_publish_has_a_fight_before_anything_is_sent() -> None:
    assert only(topic("/drive_safe", "/safety_stop /rogue", kind=DRIVE)).rule == "fight"
    assert found(topic("/drive_safe", "/safety_stop", kind=DRIVE)) == []
    assert only(topic("/clock", "/gazebo /bag", kind="rosgraph_msgs/msg/Clock")).rule == "fight"


def test_mixed_measurements_are_a_warning() -> None:
    finding = only(topic("/sensor/sonar_front", "/mock_sonar /tof_sonar", several_send=True))
    assert (finding.level, finding.rule) == (FindingLevel.WARNING, "fight")


def test_deck_itself_may_be_who_fights() -> None:
    finding = only(topic("/drive", "/ai_driver", kind=DRIVE, several_send=True, own_publishers=1))
    assert "/ai_driver, Deck" in finding.what
    assert finding.nodes == ("/ai_driver",)
    # The publisher of another screen is there before it is needed.
    assert found(topic("/drive_safe", "/safety_stop /_deck_observer_7", kind=DRIVE)) == []


def test_a_fight_of_one_name_may_be_a_node_and_its_successor() -> None:
    finding = only(topic("/drive_safe", "/safety_stop /safety_stop", kind=DRIVE))
    assert finding.settled_s == FORGOTTEN_S
    assert "/safety_stop ×2" in finding.what


def test_nodes_with_one_name_are_told_by_their_processes_or_by_what_a_node_has_once() -> None:
    twice = topic("/rosout", "/twin /twin /other", kind="rcl_interfaces/msg/Log")
    rows = (NodeRow("/twin", processes=(3,)), NodeRow("/other", processes=(4, 5)), NodeRow("/one"))
    findings = found(twice, nodes=rows)
    assert [one.place.name for one in findings] == ["/other", "/twin"]
    assert {one.rule for one in findings} == {"namesakes"}
    assert {one.settled_s for one in findings} == {FORGOTTEN_S}


def test_a_topic_with_two_types_names_who_uses_which() -> None:
    row = topic(
        "/chatter", published_by=(end("/talker", STRING),), subscribed_by=(end("/listener"),)
    )
    finding = only(row)
    assert (finding.rule, finding.level) == ("two-types", FindingLevel.ERROR)
    assert f"{FLOAT} (/listener), {STRING} (/talker)" in finding.what
    assert finding.nodes == ("/listener", "/talker")


def test_a_type_that_cannot_be_subscribed_as_another_is_in_use_is_told_once() -> None:
    row = topic("/chatter", published_by=(end("/a", STRING), end("/b")))
    assert only(replace(row, trouble=Trouble.UNKNOWN_TYPE, detail="busy")).rule == "two-types"


def test_services_and_actions_have_one_type_too() -> None:
    nodes = (NodeRow("/caller", clients=("/add",)),)
    service = ServiceRow("/add", ("a/srv/Add",), ("/server",), called_as=("a/srv/Sum",))
    finding = only(services=(service,), nodes=nodes)
    assert (finding.rule, finding.place) == ("two-types", ("service", "/add"))
    assert finding.nodes == ("/server", "/caller")
    assert "a/srv/Add, a/srv/Sum" in finding.what
    action = ActionRow("/go", ("a/action/Go", "b/action/Go"), ("/server",), ("/caller",))
    assert only(actions=(action,)).place == ("action", "/go")


def test_an_unknown_type_says_what_to_install() -> None:
    row = topic("/gps", "/gps", kind="ublox_msgs/msg/Fix", trouble=Trouble.UNKNOWN_TYPE,
                detail="install ublox_msgs")  # fmt: skip
    finding = only(row)
    assert (finding.rule, finding.mend) == ("unknown-type", "install ublox_msgs")
    assert "ublox_msgs/msg/Fix" in finding.what


@pytest.mark.parametrize(
    ("offered", "asked", "words"),
    [
        ({"reliability": "best_effort"}, {}, "reliability reliable is asked for, best_effort"),
        (
            {},
            {"durability": "transient_local"},
            "durability transient_local is asked for, volatile",
        ),
        (
            {"deadline_s": 2.0},
            {"deadline_s": 0.5},
            "at least every 0.5 s (deadline), 2 s is offered",
        ),
        ({}, {"deadline_s": 0.5}, "at least every 0.5 s (deadline), nothing is offered"),
        ({}, {"lease_s": 0.5}, "at least every 0.5 s (liveliness lease duration), nothing"),
    ],
)
def test_qos_that_does_not_fit(offered: Any, asked: Any, words: str) -> None:
    row = topic(
        "/scan", published_by=(end("/lidar", **offered),), subscribed_by=(end("/nav", **asked),)
    )
    finding = only(row)
    assert (finding.rule, finding.level) == ("qos", FindingLevel.ERROR)
    assert finding.nodes == ("/lidar", "/nav")
    assert "/nav does not hear /lidar" in finding.what
    assert words in finding.what
    assert finding.mend.startswith("Let /lidar offer ")


def test_more_pairs_are_counted() -> None:
    hearers = tuple(end(f"/nav{number}") for number in range(3))
    lidar = (end("/lidar", reliability="best_effort"),)
    finding = only(topic("/scan", published_by=lidar, subscribed_by=hearers))
    assert "(and 2 more such pairs)" in finding.what


def test_losses_that_matter_are_told_with_their_cause() -> None:
    camera = (end("/camera", reliability="best_effort"),)
    finding = only(topic("/image", published_by=camera, lost=30, count=70, measured=True))
    assert (finding.rule, finding.level) == ("lost", FindingLevel.WARNING)
    assert "30 of 100" in finding.what
    assert "best_effort" in finding.what
    burst = (end("/burst", depth=1),)
    finding = only(topic("/burst", published_by=burst, lost=30, count=70, measured=True))
    assert "deeper queue than 1" in finding.mend
    for lost, count in ((19, 0), (30, 1000)):
        assert found(topic("/image", published_by=camera, lost=lost, count=count)) == []


def test_many_may_publish_the_states_of_joints() -> None:
    joints = topic("/joint_states", "/arm /base", "", "sensor_msgs/msg/JointState")
    assert found(replace(joints, several_send=True)) == []
    assert only(replace(joints, name="/head_state", several_send=True)).rule == "fight"


def test_a_subscriber_that_nobody_feeds() -> None:
    finding = only(topic("/scan", "", "/nav /rviz", RANGE))
    assert (finding.rule, finding.level) == ("unfed", FindingLevel.WARNING)
    assert finding.nodes == ("/nav", "/rviz")
    assert found(topic("/scan", "", "/_deck_recorder_3", RANGE)) == []
    assert found(topic("/scan", "", "/nav", RANGE, own_publishers=1)) == []


@pytest.mark.parametrize("name", ["/scan", "/sensor/sonar_frnt"])
def test_who_hears_without_a_name_may_be_a_node_that_starts_or_has_died(name: str) -> None:
    nameless = f"/{NAMELESS}"
    assert only(FED, topic(name, "", nameless)).settled_s == FORGOTTEN_S
    assert only(FED, topic(name, "", f"{nameless} /nav")).settled_s == SETTLED_S


def test_a_name_that_nearly_matches_is_worse_than_none() -> None:
    finding = only(FED, topic("/sensor/sonar_frnt", "", "/guard"))
    assert (finding.rule, finding.level) == ("near-name", FindingLevel.ERROR)
    assert "/sensor/sonar_front" in finding.what
    assert "-r /sensor/sonar_frnt:=/sensor/sonar_front" in finding.mend
    assert finding.nodes == ("/guard", "/sonar_front")
    # Also of what may wait, but not of another type.
    stop = topic("/emergency_stop", "", "/gate", "std_msgs/msg/Bool")
    assert only(stop, topic("/emergency_stpo", "/me", "", "std_msgs/msg/Bool")).rule == "near-name"
    drive = topic("/drive", "/ai_driver", "/gate", DRIVE)
    assert only(drive, topic("/drve", "", "/wheels", DRIVE)).rule == "near-name"
    assert only(FED, topic("/sensor/sonar_frnt", "", "/guard", STRING)).rule == "unfed"


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


def test_the_nearest_name_is_meant() -> None:
    assert meant("/scan", ["/robot/scan", "/scann", "/map"]) == "/scann"


def test_a_service_that_nobody_serves() -> None:
    nodes = (
        NodeRow("/brain", clients=("/set_head_postion", "/other/get_parameters")),
        NodeRow("/_deck_observer_1", clients=("/nowhere",)),
    )
    served = (ServiceRow("/set_head_position", ("a/srv/B",), ("/head",)),)
    finding = only(nodes=nodes, services=served)
    assert (finding.rule, finding.place) == ("unserved", ("service", "/set_head_postion"))
    assert "served is /set_head_position" in finding.what
    action = ActionRow("/go", ("a/action/Go",), (), ("/caller",))
    finding = only(actions=(action,))
    assert (finding.rule, finding.place) == ("unserved", ("action", "/go"))


CLOCK_TYPE = "rosgraph_msgs/msg/Clock"


def test_a_simulated_time_that_nobody_publishes() -> None:
    finding = only(topic("/clock", "", "/nav", CLOCK_TYPE))
    assert (finding.rule, finding.nodes) == ("no-clock", ("/nav",))
    assert finding.level is FindingLevel.ERROR


def test_nodes_that_follow_different_clocks() -> None:
    rows = (topic("/clock", "/gazebo", "/nav", CLOCK_TYPE), topic("/map", "/slam"))
    nodes = tuple(NodeRow(name, publishes=("/map",)) for name in ("/gazebo", "/nav", "/slam"))
    finding = only(*rows, nodes=nodes)
    assert (finding.rule, finding.nodes) == ("clock-mix", ("/slam",))
    assert found(topic("/clock", "/gazebo", "", CLOCK_TYPE), rows[1], nodes=nodes) == []


@pytest.mark.parametrize(
    ("seen", "words"),
    [
        ({"clock_off_s": 1.7e9}, "19676 days behind"),
        ({"clock_off_s": -1200.0}, "20 min ahead"),
        ({"latency_s": -2.5}, "2.5 s in the future"),
        ({"latency_s": 7.0}, "arrive 7.0 s after their stamp"),
    ],
)
def test_stamps_of_another_clock(seen: dict[str, Any], words: str) -> None:
    finding = only(topic("/imu", "/imu", measured=True, **seen))
    assert (finding.rule, finding.level) == ("clock", FindingLevel.WARNING)
    assert words in finding.what


def test_stamps_that_may_be_as_they_are() -> None:
    assert found(topic("/imu", "/imu", latency_s=-0.05)) == []
    latched = (end("/map", durability="transient_local"),)
    assert found(topic("/map", published_by=latched, latency_s=300.0)) == []
    simulated = topic("/clock", "/gazebo", "", CLOCK_TYPE)
    assert found(simulated, topic("/imu", "/imu", clock_off_s=1.7e9)) == []


def test_what_came_regularly_and_stopped_is_told() -> None:
    silent = topic("/sensor/sonar_front", "/sonar_front", trouble=Trouble.QUIET, age_s=8.0,
                   steady_hz=20.0, measured=True)  # fmt: skip
    finding = only(silent)
    assert (finding.rule, finding.nodes) == ("silent", ("/sonar_front",))
    assert "20.0 Hz from /sonar_front, and then nothing for 8 s" in finding.what
    assert found(replace(silent, steady_hz=None)) == []
    assert found(replace(silent, name="/drive", type_names=(DRIVE,))) == []


def test_a_sensor_that_never_began_is_told() -> None:
    silent = topic("/scan", "/lidar", "", RANGE, trouble=Trouble.QUIET, measured=True)
    assert only(silent).rule == "silent"
    latched = (end("/lidar", RANGE, durability="transient_local"),)
    assert found(replace(silent, published_by=latched)) == []


def test_the_worst_comes_first() -> None:
    levels = [
        one.level
        for one in found(
            topic("/a", "", "/nav"),
            topic("/clock", "", "/nav", CLOCK_TYPE),
            topic("/b", "", "/nav"),
        )
    ]
    assert levels == sorted(levels)
    assert levels[0] is FindingLevel.ERROR


def test_names_from_anywhere_are_made_harmless_in_every_language() -> None:
    evil = f"/{EVIL}"
    rows = (
        topic(evil, "", evil),
        topic(f"{evil}2", f"{evil} {evil}3", kind=DRIVE, several_send=True),
        topic("/n", "", f"/{NAMELESS}"),
        topic("/t", published_by=(end(evil, EVIL),), subscribed_by=(end(f"{evil}4"),)),
    )
    findings = found(*rows, nodes=(NodeRow(evil, clients=(evil,), processes=(1, 2)),))
    assert len({one.rule for one in findings}) >= 4
    for one in findings:
        for code in ("en", "ru"):
            assert is_plain(localized(one.what, code))
            assert is_plain(localized(one.mend, code))


def test_a_program_without_a_node_is_called_so() -> None:
    finding = only(topic("/n", "", f"/{NAMELESS}"))
    assert "a program without a node's name" in finding.what


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


def test_an_observer_that_fails_changes_nothing_and_another_graph_all() -> None:
    lasting = LastingFindings(NORMS)
    lasting.take(TYPO, 0.0)
    lasting.take(GraphUpdate(1.0, error="gone"), 5.0)
    assert len(lasting.told(6.0)) == 1
    lasting.forget()
    assert lasting.told(6.0) == ()


def test_a_node_that_has_ended_for_good_is_told_at_once() -> None:
    lasting = LastingFindings(NORMS)
    lasting.take(GraphUpdate(0.0, (FED,)), 0.0, {"/sonar": "exit code 1"})
    (finding,) = lasting.told(0.0)
    assert (finding.rule, finding.place.name) == ("failed", "/sonar")
    assert finding.what == "It has failed, and is not started again: exit code 1"
    lasting.take(GraphUpdate(0.0, (FED,)), 1.0)
    assert lasting.told(1.0) == ()


def test_where_a_node_has_failed_commands_that_nobody_sends_are_told() -> None:
    rows = (FED, topic("/drive", "", "/safety_stop", DRIVE), topic("/say", "", "/voice", STRING))
    assert found(*rows) == []
    findings = examine(GraphUpdate(0.0, rows), NORMS, {"/ai_driver": "exit code 1"})
    told = [(finding.rule, finding.place.name) for finding in findings]
    assert told == [("failed", "/ai_driver"), ("unfed", "/drive")]
