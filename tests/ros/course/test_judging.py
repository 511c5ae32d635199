"""The judge as a process of its own, as the screen has it: it watches while a learner mends."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import aclosing
from pathlib import Path
from typing import TYPE_CHECKING

import psutil
import pytest
import yaml

from course.judging import JudgeEnded, JudgeEvent, RemoteJudge, ValuesDrawn
from course.results import State, StepResult
from launcher.client.client import launch

if TYPE_CHECKING:
    from launcher.client.client import SupervisorClient

pytestmark = pytest.mark.nightly

TALKER = """
import rclpy
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import Float32, String

rclpy.init()
node = rclpy.create_node("talker")
publisher = node.create_publisher({type}, "/chatter", 10)
node.create_timer({period}, lambda: publisher.publish({type}(data={data})))
try:
    rclpy.spin(node)
except (KeyboardInterrupt, ExternalShutdownException):
    pass
"""
RIGHT = TALKER.format(type="Float32", period=0.1, data="1.0")
CRASHES = TALKER.format(type="Float32", period=0.1, data="float(None)")
AS_TEXT = TALKER.format(type="String", period=0.1, data="'1.0'")
ENDS_BADLY = RIGHT.replace("(KeyboardInterrupt, ExternalShutdownException)", "ZeroDivisionError")
STARTS_SLOWLY = RIGHT.replace("rclpy.init()", "import time; time.sleep(0.4); rclpy.init()")
FLOOD = TALKER.format(type="Float32", period=0.0001, data="1.0")
CHATTER = {"field": "/chatter", "type": "std_msgs/msg/Float32", "path": "data", "equals": 1}
ADVICE = {"en": "Is it published by a timer?", "ru": "Публикует ли его таймер?"}
STEPS = [
    {"id": "field", "checks": [{**CHATTER, "within": 1, "look": ADVICE}]},
    {"id": "ends", "needs": ["field"], "checks": [{"ends": "talker"}]},
    {"id": "late", "needs": ["ends"], "checks": [{"node": "/talker"}]},
]

SAID_WITHIN_S = 120.0

Begin = Callable[[str], Awaitable[tuple["SupervisorClient", RemoteJudge]]]


@pytest.fixture
async def begin(tmp_path: Path, ros_domain: int) -> AsyncIterator[Begin]:
    """Have a lesson run whose only node is this, with a judge beside it."""
    clients: list[SupervisorClient] = []
    judges: list[RemoteJudge] = []

    async def started(node: str) -> tuple[SupervisorClient, RemoteJudge]:
        (tmp_path / "talker.py").write_text(node)
        profile = tmp_path / "lesson.yaml"
        values = {"n": {"between": [10, 99]}}
        nodes = {"talker": {"run": "./talker.py"}}
        profile.write_text(yaml.safe_dump({"nodes": nodes, "values": values, "steps": STEPS}))
        clients.append(await launch(profile, domain=ros_domain))
        judges.append(await RemoteJudge.start(tmp_path, clients[0].session.run_id, seed=7))
        return clients[0], judges[0]

    yield started
    for judge in judges:
        await judge.close()
    for client in clients:
        await client.shutdown()


async def step_in(events: AsyncIterator[JudgeEvent], state: State, seen: str = "") -> StepResult:
    """The next step in this state, of which this was seen; those before are passed over."""
    said: list[str] = []

    async def found() -> StepResult:
        async for event in events:
            assert not isinstance(event, JudgeEnded), event.reason
            if isinstance(event, StepResult):
                said.append(f"{event.state.value}: {''.join(check.seen for check in event.checks)}")
                if event.state is state and seen in said[-1]:
                    return event
        raise AssertionError(f"the judge has only said: {said}")

    try:
        return await asyncio.wait_for(found(), SAID_WITHIN_S)
    except asyncio.TimeoutError:
        pytest.fail(f"not within {SAID_WITHIN_S:g} s: {state} {seen!r}; the judge has said: {said}")


async def test_a_mended_node_passes_and_a_passed_step_lets_the_next_one_begin(
    begin: Begin, tmp_path: Path
) -> None:
    client, judge = await begin(AS_TEXT)
    async with aclosing(judge.events()) as events:
        drawn = await anext(events)
        assert isinstance(drawn, ValuesDrawn)
        assert drawn.seed == 7
        assert 10 <= float(drawn.values["n"]) <= 99

        judge.judge("ends")
        waiting = await step_in(events, State.WAITS)
        assert waiting.reason == "waits for: field"

        judge.judge("field")
        await step_in(events, State.FAILED, "std_msgs/msg/String, not std_msgs/msg/Float32")

        (tmp_path / "talker.py").write_text(RIGHT)
        await client.restart("talker")
        assert (await step_in(events, State.PASSED)).id == "field"

        judge.judge("ends")
        before = client.nodes["talker"].pid
        assert (await step_in(events, State.PASSED)).id == "ends"
        judge.judge("late")
        assert (await step_in(events, State.PASSED)).id == "late"
        assert client.nodes["talker"].pid != before


async def test_advice_for_a_node_that_runs_is_not_given_to_one_that_has_crashed(
    begin: Begin, tmp_path: Path
) -> None:
    """What a check advises gives way to what has ended the node."""
    client, judge = await begin(CRASHES)
    async with aclosing(judge.events()) as events:
        judge.judge("field")
        while True:
            checks = (await step_in(events, State.FAILED)).checks
            looks = [check.look for check in checks]
            if "float()" in checks[-1].seen:
                break
        assert ADVICE["en"] not in looks
        (tmp_path / "talker.py").write_text(AS_TEXT)
        await client.restart("talker")
        while ADVICE["en"] not in looks:
            looks = [check.look for check in (await step_in(events, State.FAILED)).checks]


async def test_a_saved_node_has_begun_before_it_is_told_to_end(
    begin: Begin, tmp_path: Path
) -> None:
    """One that is still importing cannot catch Ctrl-C yet, and that is no mistake of its file."""
    _client, judge = await begin(ENDS_BADLY)
    async with aclosing(judge.events()) as events:
        judge.judge("field")
        await step_in(events, State.PASSED)
        judge.judge("ends")
        await step_in(events, State.FAILED, "SIGINT")
        (tmp_path / "talker.py").write_text(STARTS_SLOWLY)
        assert (await step_in(events, State.PASSED)).id == "ends"


async def test_a_flood_is_judged_and_the_judge_ends_with_its_session(begin: Begin) -> None:
    client, judge = await begin(FLOOD)
    async with aclosing(judge.events()) as events:
        judge.judge("field")
        assert (await step_in(events, State.PASSED)).points == 1
        assert judges()
        await client.shutdown()
        last = [event async for event in events][-1]
        assert isinstance(last, JudgeEnded)
    await judge.close()
    assert not judges()


def judges() -> list[int]:
    """Return the judges that this process has started and that have not ended."""
    found = []
    for child in psutil.Process().children():
        # What has ended has no command line any more: other children may end meanwhile.
        with contextlib.suppress(psutil.NoSuchProcess):
            if "course.judge" in " ".join(child.cmdline()):
                found.append(child.pid)
    return found
