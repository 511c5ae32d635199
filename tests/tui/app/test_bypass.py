"""Whoever publishes past the gate is named in red, and the lesson's own nodes are not."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import pytest
from textual.color import Color

from graph.data import NAMELESS, EndpointInfo, GraphUpdate
from launcher.status import NodeStatus
from tests.tui.recorded import NODES, TOPICS, RecordedOpener, lesson_update, topic
from tests.tui.snapshots import opened, settle
from tui.frame.title_bar import TitleBar
from tui.session.bypass import BypassDetector

DRIVE, JOINTS = "ackermann_msgs/msg/AckermannDriveStamped", "sensor_msgs/msg/JointState"
KINDS = {"/drive_safe": DRIVE, "/wheel_commands": JOINTS}
GATE, DIFFERENTIAL = "/safety_stop", "/electronic_differential"


def graph(at_s: float = 0.0, kinds: Mapping[str, str] = KINDS, **by: tuple[str, ...]) -> GraphUpdate:
    """The lesson's graph with these publishers, by topic without its slash."""
    changed = {f"/{name}": nodes for name, nodes in by.items()}
    others = [row for row in TOPICS if row.name not in changed]
    for name, nodes in changed.items():
        kind = kinds.get(name, JOINTS)
        ends = tuple(EndpointInfo(node, kind, "reliable", "volatile") for node in nodes)
        others.append(topic(name, kind, 10.0, 60, publishers=len(nodes), published_by=ends))
    update = lesson_update(topics=tuple(sorted(others, key=lambda row: row.name)))
    return replace(update, time_s=update.time_s + at_s)


def named(update: GraphUpdate, nodes: Mapping[str, NodeStatus] = NODES) -> list[tuple[str, str]]:
    """Topic and name of each publisher that is reported."""
    bypass = BypassDetector()
    bypass.see(update, nodes)
    return [(publisher.topic, publisher.called) for publisher in bypass.now]


@pytest.mark.parametrize(
    ("by", "expected"),
    [
        ({"drive_safe": (GATE,)}, []),
        ({"drive_safe": (GATE,), "wheel_commands": (DIFFERENTIAL,)}, []),
        ({"drive_safe": (GATE, "/evil")}, [("/drive_safe", "/evil")]),
        ({"drive_safe": ("/evil",)}, [("/drive_safe", "/evil")]),
        ({"drive_safe": (GATE, "/evil/safety_stop")}, [("/drive_safe", "/evil/safety_stop")]),
        ({"wheel_commands": (DIFFERENTIAL,) * 2}, [("/wheel_commands", f"another {DIFFERENTIAL}")]),
        ({"wheel_commands": (DIFFERENTIAL, "/ai_driver")}, []),
        ({"drive": ("/ai_driver", "/evil")}, []),
    ],
    ids=str,
)
def test_who_bypasses_the_gate(by: dict[str, Any], expected: list[tuple[str, str]]) -> None:
    assert named(graph(**by)) == expected


@pytest.mark.parametrize(
    ("by", "expected"),
    [
        (("/mock_sonar",), []),
        (("/forgotten",), []),
        (("/mock_sonar", "/forgotten"), ["/forgotten"]),
        (("/one", "/other"), ["/one", "/other"]),
        (("/mock_sonar", "/ai_brain"), ["/mock_sonar", "/ai_brain"]),
        (("/mock_sonar",) * 2, ["another /mock_sonar"]),
    ],
    ids=str,
)
def test_who_speaks_for_a_sonar_beside_another(by: tuple[str, ...], expected: list[str]) -> None:
    sonar = replace(NODES["ai_brain"], name="mock_sonar")
    bypass = BypassDetector()
    alone: dict[str, Any] = {"sensor/sonar_front": by}
    bypass.see(graph(**alone), {**NODES, "mock_sonar": sonar})
    assert [publisher.called for publisher in bypass.now] == expected
    words = "⚠ Several publish /sensor/sonar_front: {} · the lowest distance counts"
    assert not expected or bypass.words()[0] == words.format(", ".join(expected))
    # Who commands the wheels is the worse, and the line is one.
    both = graph(drive_safe=(GATE, "/evil"), **alone)
    bypass.see(both, {**NODES, "mock_sonar": sonar})
    assert "/drive_safe: /evil ·" in bypass.words()[0]


def test_a_topic_that_the_profile_calls_otherwise_is_reserved_as_well() -> None:
    update = graph(kinds={"/safe": DRIVE}, safe=(GATE, "/evil"))
    assert named(update) == [("/safe", "/evil")]


def test_without_a_gate_of_its_own_it_takes_two() -> None:
    """A lesson whose wheels are published by hand, or the course's own nodes, only watched."""
    for nodes in ({}, {"hello": NODES["ai_brain"]}):
        assert named(graph(wheel_commands=("/_ros2cli_7",)), nodes) == []
        assert named(graph(wheel_commands=(DIFFERENTIAL, "/evil")), nodes) == [("/wheel_commands", "/evil")]


def test_a_name_is_waited_for() -> None:
    bypass, by = BypassDetector(), (GATE, f"/{NAMELESS}")
    assert not bypass.see(graph(drive_safe=by), NODES)
    assert not bypass.see(graph(2.0, drive_safe=by), NODES)
    assert bypass.see(graph(4.0, drive_safe=by), NODES)
    assert bypass.now[0].called == "a program without a node's name"
    assert bypass.see(graph(5.0, drive_safe=(GATE,)), NODES)
    assert bypass.words() == ()


async def test_it_stands_in_the_title_in_red() -> None:
    opener = RecordedOpener()
    async with opened(opener, size=(80, 24)) as (app, pilot):
        opener.graph.show(graph(wheel_commands=(DIFFERENTIAL, "/evil")))
        await settle(pilot)
        bar = app.screen.query_one(TitleBar)
        assert "Foreign commands on /wheel_commands: /evil" in bar.text
        assert bar.get_visual_style("title-bar--danger").background == Color.parse("#b00020")
        assert any("/evil" in told.message for told in app._notifications)
        await pilot.press("space")
        await settle(pilot)
        assert "EMERGENCY STOP" in bar.text
        await pilot.press("ctrl+r")
        opener.graph.show(graph(wheel_commands=(DIFFERENTIAL,)))
        await settle(pilot)
        assert "/evil" not in bar.text
