"""The screen of topics over a recorded graph, under a pilot."""

from __future__ import annotations

from contextlib import AbstractAsyncContextManager
from dataclasses import replace
from typing import Any

import cv2
import numpy as np
from textual.widgets import Static

from graph.data import GraphUpdate, TopicRow
from tests.tui.recorded import TOPICS, lesson_update, sample
from tests.tui.recorded_lesson import colour_bars
from tests.tui.screen_stage import HOME, ScreenStage, on_stage
from tests.tui.snapshots import Look
from tests.waiting import until
from tui.session.past import TRENDS
from tui.topics.detail import TopicHead
from tui.topics.screen import TopicsScreen

SONAR, CAMERA = "/sensor/sonar_front", "/camera/color/image_raw"


class TopicsStage(ScreenStage[TopicsScreen]):
    """The screen of topics."""

    name, kind = "topics", TopicsScreen

    def measures(self) -> bool:
        """Whether the rates of all topics are asked for now."""
        return self.graph.wanted.all_fast

    def as_picture(self) -> bool:
        """Whether the message is shown as a picture now."""
        return self.screen.detail.as_picture

    async def choose(self, topic: str) -> None:
        """Choose a topic and wait until it is asked for."""
        self.screen.table.choose(topic)
        await until(
            lambda: {*self.graph.wanted.watched, *TRENDS} | self.graph.wanted.pictures == {topic, *TRENDS},
            lambda: f"{topic}, but {self.graph.wanted.watched}, {self.graph.wanted.pictures}",
        )
        await self.pilot.pause()

    async def decoded(self) -> None:
        under_way = [worker for worker in self.app.workers if worker.group == "pictures"]
        if under_way:
            await self.app.workers.wait_for_complete(under_way)
        await self.pilot.pause()

    def head(self) -> str:
        return str(self.screen.query_one(TopicHead).content)

    def count(self) -> str:
        return str(self.screen.query_one("#topics-count", Static).content)

    def echo(self) -> str:
        tree = self.screen.detail.echo
        return "\n".join(tree.render_line(y).text.rstrip() for y in range(tree.size.height)).strip()


def opened(look: Look = HOME) -> AbstractAsyncContextManager[TopicsStage]:
    """Open the screen of topics of lesson 9."""
    return on_stage(TopicsStage, look=look)


def row(name: str, **more: Any) -> TopicRow:
    return replace(next(row for row in TOPICS if row.name == name), **more)


def with_row(changed: TopicRow, **samples: Any) -> GraphUpdate:
    others = [row for row in TOPICS if row.name != changed.name]
    return lesson_update(topics=(*others, changed), samples=samples)


def depth_message() -> dict[str, Any]:
    """A slope from half a metre to four, without a reading at the left."""
    numbers = np.repeat(np.linspace(520, 3970, 64)[None, :], 48, axis=0).astype("<u2")
    numbers[:, :6] = 0
    size = {"width": 64, "height": 48, "step": 128, "encoding": "16UC1", "is_bigendian": 0}
    return {**size, "data": numbers.tobytes()}


def jpeg_message(cut_to: int | None = None) -> dict[str, Any]:
    """The recorded camera's picture as JPEG, or its beginning only."""
    pixels = np.frombuffer(colour_bars(), np.uint8).reshape(480, 640, 3)
    return {"format": "jpeg", "data": cv2.imencode(".jpg", pixels)[1].tobytes()[:cut_to]}


def with_camera(type_name: str, value: dict[str, Any]) -> GraphUpdate:
    return with_row(row(CAMERA, type_names=(type_name,)), **{CAMERA: (sample(CAMERA, type_name, value),)})
