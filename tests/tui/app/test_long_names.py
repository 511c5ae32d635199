"""A name that its list has no room for is told whole beside it."""

from __future__ import annotations

from dataclasses import replace

import pytest

from launcher.status import NodeState, NodeStatus
from tests.tui.app_runs import opened
from tests.tui.recorded import NODES, RecordedOpener, RecordedSession
from tests.tui.snapshots import settle
from tui.app import DeckApp
from tui.deck.screen import LessonDeck
from tui.widgets.name_head import NameHead

pytestmark = pytest.mark.nightly


LONG = "a_rather_long_name_of_a_node_" * 3 + "END"
REASON = "waits for /camera/color/image_raw of sensor_msgs/msg/Image, which nobody publishes; " * 2
STATES = [
    (replace(NODES["camera"], name=LONG), [LONG, "● ready · nodes.mock_camera"]),
    (
        NodeStatus("camera", "nodes.mock_camera", NodeState.WAITING, REASON),
        ["camera", "◌ waiting · " + REASON.strip()],
    ),
]


def opener_with(node: NodeStatus) -> RecordedOpener:
    """Lesson 9 whose last node is this one."""
    nodes = {**NODES, node.name: node}
    return RecordedOpener(RecordedSession(nodes={name: nodes[name] for name in nodes}))


def told_below(app: DeckApp) -> list[str]:
    """The name and the rest, as they stand on the screen between the table and what follows."""
    assert isinstance(app.screen, LessonDeck)
    head = app.screen.query_one(NameHead)
    if not head.display:
        return []
    x, y, width, height = head.region
    screen = app.screen._compositor.render_strips()
    return [screen[row].crop(x, x + width).text.strip() for row in range(y, y + height)]


@pytest.mark.parametrize("size", [(80, 24), (100, 30), (120, 40)])
@pytest.mark.parametrize(("node", "expected"), STATES, ids=["name", "reason"])
async def test_what_the_table_of_nodes_cuts_stands_whole_below_it(
    size: tuple[int, int], node: NodeStatus, expected: list[str]
) -> None:
    async with opened(opener_with(node), size=size) as (app, pilot):
        assert isinstance(app.screen, LessonDeck)
        assert told_below(app) == []
        app.screen.table.choose(node.name)
        await settle(pilot)
        told = " ".join(told_below(app))
        for words in expected:
            assert words.replace(" ", "") in told.replace(" ", "")
        assert app.screen.table.size.height >= 2
        app.screen.table.choose("audio")
        await settle(pilot)
        assert told_below(app) == []
