"""Lessons for the tests of grading: small, and judged within seconds."""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING

from course.grade.submission import Submission, submissions
from course.lessons.lesson import LessonFolder

if TYPE_CHECKING:
    from pathlib import Path

LOGS = """
title: {en: Logs}
nodes:
  talker: {exec: [python3, ./starter/talker.py]}
steps:
  - id: ready
    checks:
      - log: talker
        matches: ready
        within: 8
  - id: calm
    points: 2
    checks:
      - python: checks.py:calm
        topics: {}
        within: 0.2
"""
"""Judged by what a node prints: it needs no ROS, and starts at once."""
CHECKS = """
def calm(seen):
    return {"en": "it is not calm"} if any("wild" in line for line in seen.logs["talker"]) else None
"""
PROFILE = """
title: {en: Logs}
nodes:
  talker: {exec: [python3, talker.py]}
"""
TOPICS = """
title: {en: Topics}
nodes:
  talker: {run: ./starter/talker.py}
values:
  word: {one_of: [one, two, three]}
steps:
  - id: topic
    checks:
      - field: /chatter
        type: std_msgs/msg/String
        path: data
        equals: hello
        messages: 20
        within: 10
"""
TALKER = """
import rclpy
from std_msgs.msg import String

rclpy.init()
node = rclpy.create_node("talker")
publisher = node.create_publisher(String, "{topic}", 10)
node.create_timer(0.1, lambda: publisher.publish(String(data="hello")))
try:
    rclpy.spin(node)
except KeyboardInterrupt:
    pass
"""


def log_lesson(place: Path) -> LessonFolder:
    """A lesson of two steps: `ready` is printed, and nothing `wild`."""
    return _lesson(place, LOGS, PROFILE)


def topic_lesson(place: Path) -> LessonFolder:
    """A lesson of one step: a greeting comes on /chatter."""
    return _lesson(place, TOPICS, "title: {en: Topics}\nnodes: {talker: {run: ./talker.py}}\n")


def _lesson(place: Path, text: str, profile: str) -> LessonFolder:
    (place / "starter").mkdir(parents=True)
    (place / "lesson.yaml").write_text(text)
    (place / "checks.py").write_text(CHECKS)
    (place / "starter" / "lesson.yaml").write_text(profile)
    (place / "starter" / "talker.py").write_text("")
    return LessonFolder(place)


def handed_in(lesson: LessonFolder, place: Path, **nodes: str) -> list[Submission]:
    """A folder for each learner, with a talker.py of this text."""
    folders = []
    for name, text in nodes.items():
        folder = place / name
        folder.mkdir(parents=True)
        (folder / "talker.py").write_text(textwrap.dedent(text))
        folders.append(folder)
    return submissions(lesson, folders)
