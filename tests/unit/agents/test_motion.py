"""What agents may do: ways, proposals, raw access, and what is written of it."""

from __future__ import annotations

import asyncio
import contextlib
import json
import math
import stat
from pathlib import Path
from typing import Any

import pytest
from pydantic import ValidationError

from agents.acting import KEPT, check_call, check_publish
from agents.driving import AgentDriving
from agents.http import own_token, token_path
from agents.motion import (
    EXECUTED_WITHIN_S,
    MAX_HEADS,
    MAX_OPEN,
    Motion,
    ProposalBook,
    check_rules,
    motion_words,
    preview_of,
    read_motion,
)
from agents.refusal import RefusedError
from agents.server import LONGEST_NAME, shown_name
from agents.session import MAX_ARGUMENTS, Audit, SessionFinder
from agents.tools import TOOLS, tools_for
from launcher.consent import ALLOWED_FOR_S, AgentRules, Approval
from launcher.errors import UsageError
from robot.commands.schema import parse_llm
from safety.gate_report import Gate
from tests.hostile_text import WORST
from text.i18n import localized
from text.robot import robot

RULES = AgentRules(max_speed_m_s=0.2, max_distance_m=0.5)


def drive(speed: float, steering: float = 0.0) -> dict[str, Any]:
    return {"action": "drive", "speed": speed, "steering": steering}


def head(pan: int, tilt: int = 0) -> dict[str, Any]:
    return {"action": "turn_head", "pan": pan, "tilt": tilt}


def test_a_drive_goes_as_far_as_it_is_repeated() -> None:
    motion = read_motion([drive(-0.2), head(-45, 10)])
    assert motion.moves_wheels
    assert motion.distance_m(2.0) == pytest.approx(0.4)
    assert [str(words) for words in motion_words(motion, 2.0)] == [
        "drives at -0.2 m/s, steering 0 rad, for 2 s: 0.40 m at most",
        "turns the head (pan/tilt): -45°/10°",
    ]


def test_what_is_sent_is_what_was_checked() -> None:
    motion = read_motion([head(-45, 10), drive(0.1, 0.2)])
    sent = parse_llm(motion.response("p1: why"))
    assert sent.thought == "p1: why"
    assert [command.action for command in sent.commands] == ["drive", "turn_head"]
    assert json.loads(motion.response(""))["commands"][0] == drive(0.1, 0.2)


@pytest.mark.parametrize("speed", [0.2, -0.2, 0.0])
def test_what_the_rules_permit(speed: float) -> None:
    check_rules(read_motion([drive(speed)]), RULES, 2.5)


@pytest.mark.parametrize(
    ("speed", "repeat_for_s", "word"),
    [(0.21, 1.0, "too fast"), (-0.3, 1.0, "too fast"), (0.2, 2.6, "too far"), (0.1, 60, "too far")],
)
def test_what_no_approval_lifts(speed: float, repeat_for_s: float, word: str) -> None:
    with pytest.raises(RefusedError, match=word):
        check_rules(read_motion([drive(speed)]), RULES, repeat_for_s)


@pytest.mark.parametrize(
    "commands",
    [
        [], [drive(0.1), drive(0.0)], [head(1)] * (MAX_HEADS + 1), [drive(0.6)], [drive(math.nan)],
        [drive(math.inf)], [head(91)], [{"action": "fly"}], [{**drive(0.1), "for": 3}], ["drive"],
        [{1: object()}], [drive(0.1)] * 1000,
    ],
)  # fmt: skip
def test_what_is_no_motion(commands: list[Any]) -> None:
    with pytest.raises(RefusedError):
        read_motion(commands)


def gate(verdict: str = "free", front: float = 3.0, rear: float = 3.0) -> Gate:
    """A gate that stops at 0.5 m and slows down at 1 m."""
    return Gate(verdict, metres={"front": front, "rear": rear}, critical_m=0.5, slow_m=1.0)


@pytest.mark.parametrize(
    ("report", "speed", "lets", "reach_m", "words"),
    [
        (gate(), 0.2, True, 0.4, "the gate would let it: free for 3.00 m"),
        (gate(front=1.2), 0.2, True, 0.4, "the gate would slow it down: obstacle at 1.20 m"),
        (gate(front=0.7), 0.2, True, 0.2, "would stop it after 0.20 m: obstacle at 0.70 m"),
        (gate(front=math.inf), 0.2, True, 0.4, "the gate would let it: nothing in range"),
        (gate("blocked_forward", 0.4), 0.2, False, 0.0, "would hold it: obstacle at 0.40 m"),
        (gate("blocked_forward", 0.4), -0.2, True, 0.4, "the gate would let it: free for 3.00 m"),
        (gate("blocked_backward", rear=0.1), -0.2, False, 0.0, "would hold it: obstacle at 0.10"),
        (gate("blocked", 0.4), 0.2, False, 0.0, "would hold it"),
        (gate("emergency_stop"), 0.2, False, 0.0, "would hold it: emergency stop"),
        (gate("starting"), 0.2, False, 0.0, "would hold it: it is starting"),
        (Gate("free"), -0.2, True, 0.4, "no sensor sees that way"),
        (Gate("blocked_forward", {"front": "silent"}), 0.2, False, 0.0, "gives no distance"),
    ],
)
def test_what_it_would_do(report: Gate, speed: float, lets: bool, reach_m: float, words: str) -> None:
    found = preview_of(report, speed, 0.4)
    assert found.lets == lets
    assert found.reach_m == pytest.approx(reach_m)
    assert words in str(found.words)


STRING = "std_msgs/msg/String"
TRIGGER = "std_srvs/srv/Trigger"


def test_what_is_listed_is_allowed_and_nothing_else() -> None:
    check_publish("/lamp", STRING, ("lamp",))
    check_call("/lamp_on", TRIGGER, ("/lamp_on",))
    with pytest.raises(RefusedError, match="does not list"):
        check_publish("/lamp2", STRING, ("/lamp",))
    with pytest.raises(RefusedError, match="does not list"):
        check_call("/lamp_off", TRIGGER, ("/lamp_on",))


@pytest.mark.parametrize("topic", sorted(KEPT | robot().moving))
def test_no_profile_opens_what_moves_or_what_safety_rests_on(topic: str) -> None:
    with pytest.raises(RefusedError, match="may move the robot"):
        check_publish(topic, STRING, (topic,))


@pytest.mark.parametrize(
    ("service", "type_name"),
    [
        ("/set_head_position", "x_msgs/srv/X"),
        ("/robot/set_head_position", "x_msgs/srv/X"),
        ("/safety_stop/set_parameters", "rcl_interfaces/srv/SetParameters"),
        ("/mine", "lifecycle_msgs/srv/ChangeState"),
    ],
)
def test_no_profile_opens_the_head_or_the_life_of_nodes(service: str, type_name: str) -> None:
    with pytest.raises(RefusedError):
        check_call(service, type_name, (service,))


class Time:
    """A clock that is set."""

    now_s = 0.0

    def __call__(self) -> float:
        return self.now_s


def test_it_is_taken_once() -> None:
    book = ProposalBook()
    made = book.add("a", "run", Motion(), "")
    assert book.take(made.id, "a", "run") is made
    with pytest.raises(RefusedError, match="carried out once"):
        book.take(made.id, "a", "run")
    assert book.add("a", "run", Motion(), "").id != made.id


def test_it_is_of_one_agent_and_one_session() -> None:
    book = ProposalBook()
    made = book.add("a", "run", Motion(), "")
    with pytest.raises(RefusedError):
        book.take(made.id, "b", "run")
    with pytest.raises(RefusedError, match="another session"):
        book.take(made.id, "a", "run 2")


def test_it_expires() -> None:
    now = Time()
    book = ProposalBook(now)
    made = book.add("a", "run", Motion(), "")
    now.now_s = EXECUTED_WITHIN_S + 0.1
    with pytest.raises(RefusedError, match="older than 60 s"):
        book.take(made.id, "a", "run")


def test_a_stop_ends_them_and_old_ones_make_way() -> None:
    book = ProposalBook()
    made = [book.add("a", "run", Motion(), "") for _ in range(MAX_OPEN + 1)]
    with pytest.raises(RefusedError):
        book.take(made[0].id, "a", "run")
    book.clear()
    with pytest.raises(RefusedError):
        book.take(made[-1].id, "a", "run")


def test_ways_without_a_question_add_up_for_as_long_as_an_allowance(monkeypatch: pytest.MonkeyPatch) -> None:
    now = Time()
    monkeypatch.setattr("time.monotonic", now)
    driving = AgentDriving(Approval.ALWAYS)
    driving.drove_unasked(0.6)
    now.now_s = 100.0
    driving.drove_unasked(0.3)
    assert driving.unasked_m() == pytest.approx(0.9)
    now.now_s = ALLOWED_FOR_S + 1
    assert driving.unasked_m() == pytest.approx(0.3)


def test_each_tool_says_what_it_is_for_and_takes_its_own_arguments_only() -> None:
    assert set(TOOLS) == {
        *("look", "see", "topics", "graph", "echo", "propose", "execute", "head", "stop", "say", "publish", "call"),
    }  # fmt: skip
    assert all(tool.about for tool in TOOLS.values())
    assert dict(TOOLS["see"].arguments.model_validate({"width": 64})) == {"topic": None, "width": 64}
    for given in ({"width": 5}, {"height": 64}, {"topic": "a b"}):
        with pytest.raises(ValidationError):
            TOOLS["see"].arguments.model_validate(given)
    assert {tool.name for tool in tools_for(RULES)}.isdisjoint({"publish", "call"})
    assert "publish" in {tool.name for tool in tools_for(AgentRules(publish=("/lamp",)))}


def test_a_call_is_a_line_of_json(tmp_path: Path) -> None:
    audit = Audit(str(tmp_path))
    audit.write("claude", "say", {"text": WORST}, "done", 0.25)
    audit.write("claude", "echo", {"topic": "x" * 100_000}, "refused", 0.1)
    first, second = audit.path.read_text("utf-8").splitlines()
    assert first.isprintable()
    assert json.loads(first)["arguments"] == {"text": WORST}
    assert {**json.loads(first), "time": 0} == {
        "time": 0,
        "client": "claude",
        "tool": "say",
        "arguments": {"text": WORST},
        "outcome": "done",
        "seconds": 0.25,
    }
    assert len(second) < MAX_ARGUMENTS + 200
    assert stat.S_IMODE(audit.path.stat().st_mode) == 0o600


@pytest.fixture(autouse=True)
def _own_config(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "config"))


def test_the_token_is_made_once_and_is_private() -> None:
    token = own_token()
    assert len(token) >= 32
    assert own_token() == token
    assert stat.S_IMODE(token_path().stat().st_mode) == 0o600


def test_a_token_that_others_can_read_is_refused() -> None:
    own_token()
    token_path().chmod(0o644)
    with pytest.raises(UsageError, match="can be read by others"):
        own_token()


@pytest.mark.parametrize(("discovery", "told"), [("subnet", True), ("localhost", False)])
async def test_whoever_looks_on_the_network_is_told_where_agents_are_served(
    discovery: str, told: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    monkeypatch.setenv("DECK_RUN_DIR", str(tmp_path / "runs"))
    finder = SessionFinder(None, None, lambda: None, discovery)
    looking = asyncio.create_task(finder.keep())
    try:
        with pytest.raises(RefusedError) as refusal:
            await finder.session()
    finally:
        looking.cancel()
        with contextlib.suppress(asyncio.CancelledError):
            await looking
    said = localized(refusal.value.words)
    assert "nothing runs in the background" in said
    assert ("start deck mcp on it, over SSH" in said) is told


@pytest.mark.parametrize(
    ("given", "shown"),
    [
        ("Claude Desktop 1.2", "Claude-Desktop-1.2"),
        ("агент", "агент"),
        ("x” may drive until 12:00. Press “y", "x-may-drive-until-12-00.-Press-y"),
        ("\x1b[31m\u202e red\n\nline", "31m-red-line"),
        ("  ", ""),
        ("a" * 10_000, "a" * LONGEST_NAME),
    ],
)
def test_the_name_that_an_agent_gives_itself_is_one_short_word(given: str, shown: str) -> None:
    assert shown_name(given) == shown
