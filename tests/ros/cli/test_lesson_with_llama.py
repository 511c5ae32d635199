"""Lesson 9 with a language model on this machine, from the file to the wheels: no stand-ins."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from ackermann_msgs.msg import AckermannDriveStamped
from diagnostic_msgs.msg import DiagnosticArray
from sensor_msgs.msg import JointState

from tests.deck_process import DeckProcess
from tests.ros.peer import Peer
from tests.served_model import served
from tests.tiny_model import DRIVES, GARBLES, SPEEDS, Habits, write_model
from tests.waiting import wait_until

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

pytestmark = pytest.mark.nightly


class Lesson:
    """Lesson 9, thinking with a model, and what is heard of it."""

    def __init__(self, domain: int) -> None:
        self.deck = DeckProcess("run", "09-brain", "--domain", str(domain))
        self.peer = Peer(domain)
        self.drives = self.peer.hear("/drive", AckermannDriveStamped)
        self.wheels = self.peer.hear("/wheel_commands", JointState)
        self._states = self.peer.hear("/brain_state", DiagnosticArray)

    def close(self) -> None:
        self.peer.close()
        self.deck.close()

    def turning(self) -> bool:
        """Whether a wheel has turned; the steering joint has no velocity: nan."""
        return any(abs(velocity) > 0.01 for each in list(self.wheels) for velocity in each.velocity)

    def answered(self) -> list[dict[str, str]]:
        """Return what the brain has told of each answer of the model."""
        told = [{value.key: value.value for value in message.status[0].values} for message in list(self._states)]
        return [state for state in told if state.get("total_s")]


@pytest.fixture
def lesson(
    request: pytest.FixtureRequest, ros_domain: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Iterator[Lesson]:
    """The lesson with a model of the habits that the test names."""
    habits: Habits = request.param
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    with served(write_model(tmp_path / "tiny.gguf", habits)) as model:
        monkeypatch.setenv("DECK_LLM_BASE_URL", model.base_url)
        monkeypatch.setenv("DECK_LLM_MODEL", model.name)
        lesson = Lesson(ros_domain)
        try:
            yield lesson
        finally:
            lesson.close()


def _by_the_model(message: AckermannDriveStamped) -> bool:
    """Whether it drives forward and to the left: the rules would drive straight on."""
    numbers = message.drive.speed, message.drive.steering_angle
    return all(0.1 <= round(number, 3) <= 0.4 for number in numbers)


@pytest.mark.slow
@pytest.mark.parametrize("lesson", [DRIVES], indirect=True)
def test_what_a_model_says_turns_the_wheels(lesson: Lesson) -> None:
    wait_until(
        lambda: any(map(_by_the_model, list(lesson.drives))),
        lambda: f"its command on /drive: {lesson.deck.lines[-20:]}",
    )
    wait_until(lesson.turning, "turning wheels")
    state = wait_until(lesson.answered, "what the answer took")[-1]
    assert (state["model"], state["fault"]) == ("tiny", "")
    assert int(state["output_tokens"]) > 50


@pytest.mark.slow
@pytest.mark.parametrize("lesson", [SPEEDS, GARBLES], ids=["speeds", "garbles"], indirect=True)
def test_what_deck_refuses_turns_no_wheel(lesson: Lesson) -> None:
    told = lesson.deck.said("; I stand")
    assert "No answer: " in told
    wait_until(lambda: len(lesson.wheels) > 5, "the wheels' node")
    assert not lesson.turning()
