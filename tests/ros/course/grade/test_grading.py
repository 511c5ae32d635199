"""Grading with ROS: two at once do not meet, recordings are kept, and the command says it all."""

from __future__ import annotations

import json
import signal
import uuid
from pathlib import Path

import yaml

from course.grade.grades import Grade, GradeState
from course.grade.grading import Terms, grade_all
from launcher.processes.table import command_line, process_numbers
from tests.deck_process import DeckProcess
from tests.ros.course.grade.lessons import TALKER, handed_in, log_lesson, topic_lesson
from tests.waiting import wait_until

READY = "import time\nprint('ready')\ntime.sleep(1000)\n"


async def test_two_at_once_do_not_meet_and_are_recorded(tmp_path: Path, ros_domain: int, other_domain: int) -> None:
    lesson = topic_lesson(tmp_path / "lesson")
    right, wrong = (TALKER.replace("{topic}", name) for name in ("/chatter", "/chater"))
    chosen = handed_in(lesson, tmp_path / "class", anna=right, boris=wrong)
    terms = Terms(lesson, seed=5, bags=tmp_path / "bags")
    domains = [ros_domain, other_domain]
    grades: dict[str, Grade] = {}
    async for _number, grade in grade_all(terms, chosen, jobs=2, domains=domains):
        grades[grade.student] = grade
    assert grades["anna"].state is GradeState.PASSED
    assert grades["boris"].state is GradeState.FAILED
    assert "/chater" in grades["boris"].steps[0].message
    assert grades["anna"].seed == grades["boris"].seed == 5
    assert grades["anna"].values == grades["boris"].values
    assert _recorded(grades["anna"])["/chatter"] > 0
    assert "/chater" not in _recorded(grades["anna"])


def _recorded(grade: Grade) -> dict[str, int]:
    assert grade.bag is not None
    metadata = yaml.safe_load((grade.bag / "metadata.yaml").read_text())
    topics = metadata["rosbag2_bagfile_information"]["topics_with_message_count"]
    return {topic["topic_metadata"]["name"]: topic["message_count"] for topic in topics}


def test_the_command_tells_people_and_programs(tmp_path: Path, ros_domain: int) -> None:
    lesson = log_lesson(tmp_path / "lesson")
    handed_in(lesson, tmp_path / "class", anna=READY, boris="")
    # A folder with none of the lesson's files is not run.
    (tmp_path / "class" / "boris" / "talker.py").unlink()
    out = tmp_path / "grades.json"
    folders = [str(tmp_path / "class" / name) for name in ("anna", "boris")]
    options = ("--unconfined", "--domain", str(ros_domain), "--format", "json", "--output", str(out))
    deck = DeckProcess("grade", str(lesson.path), *folders, *options)
    assert deck.finish() == 1
    anna, boris = json.loads(out.read_text())["grades"]
    assert (anna["student"], anna["points"], anna["state"]) == ("anna", 3, "passed")
    assert (boris["student"], boris["points"], boris["state"]) == ("boris", 0, "failed")
    assert "talker.py" in boris["steps"][0]["message"]
    row = next(line for line in deck.lines if line.startswith("anna"))
    assert row.split() == ["anna", "passed", "3/3", "1", "2"]
    assert deck.lines[-1] == "passed: 1 of 2"


def test_interrupted_it_leaves_nothing(tmp_path: Path, ros_domain: int) -> None:
    lesson = log_lesson(tmp_path / "lesson")
    mark = f"1000.{uuid.uuid4().int % 10**9}"
    sleeps = f"import os; os.execvp('sleep', ['sleep', '{mark}'])"
    handed_in(lesson, tmp_path / "class", anna=sleeps)
    options = ("--unconfined", "--domain", str(ros_domain))
    deck = DeckProcess("grade", str(lesson.path), str(tmp_path / "class" / "anna"), *options)
    wait_until(lambda: _running(mark), "the node runs", 60.0)
    deck.signal(signal.SIGINT)
    assert deck.finish() == 130
    assert _running(mark) == _running(str(tmp_path)) == []
    assert not any("Traceback" in line for line in deck.errors)


def _running(words: str) -> list[str]:
    lines = [command_line(pid) for pid in process_numbers()]
    return [line for line in lines if words in line]
