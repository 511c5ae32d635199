"""The state of nodes with a lifecycle, in the Deck's table of nodes."""

from __future__ import annotations

from dataclasses import replace

import pytest

from graph.data import NodeRow
from graph.inner_states import LifecycleRow
from launcher.status import NodeState
from tests.tui.app_runs import opened
from tests.tui.recorded import RecordedGraph, RecordedOpener
from tests.tui.recorded_inner import managed_update
from tests.tui.recorded_nodes import NODE_ROWS
from tests.tui.snapshots import settle
from tui.app import DeckApp
from tui.deck.screen import LessonDeck


def states(app: DeckApp) -> dict[str, str]:
    """Node to what its row says of its state."""
    assert isinstance(app.screen, LessonDeck)
    rows = app.screen.table._rows
    return {row.cells[0].text: " ".join(row.cells[1].text.split()) for row in rows}


async def test_a_state_is_shown_in_place_of_ready_and_follows_the_node() -> None:
    opener = RecordedOpener(graph=RecordedGraph(update=managed_update()))
    async with opened(opener) as (app, pilot):
        assert states(app)["camera"] == "● inactive"
        assert states(app)["sonar_front"] == "● active"
        assert states(app)["safety_stop"] == "● ready"
        errors = (LifecycleRow("/camera", "errorprocessing"),)
        opener.graph.show(replace(managed_update(), lifecycles=errors))
        await settle(pilot)
        assert states(app)["camera"] == "● errorprocessing"
        assert states(app)["sonar_front"] == "● ready"
        opener.link.set_state("camera", NodeState.FAILED, detail="configure failed")
        await settle(pilot)
        assert states(app)["camera"] == "✗ failed configure failed"


@pytest.mark.parametrize("name", ["/arm/driver", "/driver"])
async def test_a_node_of_others_has_its_state_too(name: str) -> None:
    rows = tuple(sorted((*NODE_ROWS, NodeRow(name)), key=lambda row: row.name))
    outside = replace(managed_update(nodes=rows), lifecycles=(LifecycleRow(name, "inactive"),))
    opener = RecordedOpener(graph=RecordedGraph(update=outside))
    async with opened(opener) as (app, pilot):
        await settle(pilot)
        assert states(app)[name[1:]] == "◇ inactive"
