"""The Brain panel: what the brain does, what its answers take, and what is left of the budget."""

from __future__ import annotations

from typing import Any

import pytest

from graph.data import Sample
from tests.tui.panel_stage import alone, rows
from tests.tui.recorded import lesson_update, sample, topic
from tests.tui.recorded_brain import BRAIN_STATE, TYPE, brain_state, no_answer_yet
from tui.panels.brain import BrainPanel, BrainView


async def shown(*came: Sample, width: int = 60, height: int = 6) -> list[str]:
    panel = BrainPanel()
    app = alone(panel, width, height)
    async with app.run_test(size=(width + 4, height + 4)) as pilot:
        for one in came:
            topics = (topic(BRAIN_STATE, one.type_name, hz=1.0),)
            panel.show(lesson_update(topics=topics, samples={BRAIN_STATE: (one,)}))
        await pilot.pause()
        return [row.strip() for row in rows(panel.query_one(BrainView)) if row.strip()]


async def test_an_answer_is_shown_with_all_that_it_took() -> None:
    assert await shown(no_answer_yet(), brain_state()) == [
        "has answered; m-1",
        "412 + 86 tokens · first 0.31 s · all 1.20 s · 0.00011 USD",
        "3 of 20 calls a minute · 498 of 200000 tokens",
    ]


async def test_a_brain_without_a_model_follows_its_rules() -> None:
    values = [{"key": "backend", "value": "rules"}, {"key": "fault", "value": ""}]
    status = {"name": "ai_brain", "hardware_id": "", "level": 1, "message": "follows its rules", "values": values}
    assert await shown(sample(BRAIN_STATE, TYPE, {"status": [status]})) == ["follows its rules"]


@pytest.mark.parametrize(
    "status",
    [
        None,
        5,
        [None, 3],
        [{"level": "x", "values": {"a": 1}}],
        [{"name": "ai_brain", "message": "\x1b[2J", "values": [{"key": "tokens", "value": "x"}]}],
    ],
)
async def test_any_report_is_survived(status: Any) -> None:
    assert "\x1b" not in "".join(await shown(sample(BRAIN_STATE, TYPE, {"status": status})))
