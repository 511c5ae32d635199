"""The key that copies what is shown as a command line of `ros2`."""

from __future__ import annotations

from tests.tui import graph_stage, topics_stage
from tests.tui.graph_stage import GraphStage


async def test_a_topic_is_echoed() -> None:
    async with topics_stage.opened() as stage:
        await stage.choose(topics_stage.SONAR)
        await stage.pilot.press("Y")
        await stage.pilot.pause()
        assert stage.app.clipboard == f"ros2 topic echo {topics_stage.SONAR}"


async def test_a_node_is_told_about() -> None:
    async with graph_stage.opened() as stage:
        assert isinstance(stage, GraphStage)
        name = stage.screen.names.chosen_name
        await stage.press("Н")
        assert stage.app.clipboard == f"ros2 node info {name}"
