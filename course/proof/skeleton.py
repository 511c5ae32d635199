"""The folder that a teacher's own lesson begins as: one step, and what it takes to prove it."""

from __future__ import annotations

from pathlib import Path

from course.folder.folder import node_text
from course.lessons.lesson import WRONG
from launcher.errors import UsageError
from launcher.profile.defaults import FOLDERS_OWN
from text.sentences import say

_LESSON = """\
title: {en: My lesson, ru: Мой урок}
# The nodes of Deck that the lesson is about; here, none: the learner's own are in starter/.
nodes:
  talker: {run: ./solution/talker.py}
values:
  word: {one_of: [one, two, three]}
steps:
  - id: topic
    title: {en: Publish a text, ru: Опубликовать строку}
    file: talker.py
    checks:
      - topic: /chatter
        type: std_msgs/msg/String
    hints:
      - en: A publisher is made in __init__ by self.create_publisher.
        ru: Издатель создаётся в __init__ вызовом self.create_publisher.
  - id: rate
    title: {en: Twice a second, ru: Дважды в секунду}
    file: talker.py
    needs: [topic]
    checks:
      - topic: /chatter
        type: std_msgs/msg/String
        rate: [1.7, 2.3]
"""
_PROFILE = """\
title: {en: My lesson, ru: Мой урок}
nodes:
  talker: {run: ./talker.py}
"""
_TEXT = {
    "en": """\
# My lesson

What the learner should know before the first step.

## topic

What this step is about.

**Your task**: what is to be done in talker.py.

## rate

A timer calls a method every so many seconds.

**Your task**: publish twice a second.
""",
    "ru": """\
# Мой урок

Что ученику нужно знать до первого шага.

## topic

О чём этот шаг.

**Задание**: что нужно сделать в talker.py.

## rate

Таймер вызывает метод через заданное число секунд.

**Задание**: публикуйте дважды в секунду.
""",
}
_SOLUTION = """\
        self.publisher = self.create_publisher(String, "/chatter", 10)
        self.create_timer(0.5, self.talk)"""
_TALKS = """

    def talk(self):
        self.publisher.publish(String(data="hello"))"""
_IMPORTS = "from std_msgs.msg import String\n"
_MISSING = "        # Missing: a publisher of String on /chatter, and a timer that calls talk."
_MISTAKES = """\
What beginners get wrong, as changes of solution/: each must fail at its step, and pass those before it.

## topic/another-name
--- talker.py
-        self.publisher = self.create_publisher(String, "/chatter", 10)
+        self.publisher = self.create_publisher(String, "/chater", 10)

## rate/once-in-two-seconds
--- talker.py
-        self.create_timer(0.5, self.talk)
+        self.create_timer(2.0, self.talk)
"""
_FILES = {
    FOLDERS_OWN: _LESSON,
    "text.en.md": _TEXT["en"],
    "text.ru.md": _TEXT["ru"],
    "starter/lesson.yaml": _PROFILE,
    "starter/talker.py": node_text("talker", _MISSING + _TALKS, _IMPORTS),
    "solution/talker.py": node_text("talker", _SOLUTION + _TALKS, _IMPORTS),
    WRONG: _MISTAKES,
}


def new_lesson(folder: Path) -> Path:
    """Make the folder of a new lesson.

    Raises:
        UsageError: if something is there already.
    """
    if folder.exists():
        raise UsageError(say("{path} is there already: choose another name", path=str(folder)))
    for name, text in _FILES.items():
        file = folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, "utf-8")
    return folder
