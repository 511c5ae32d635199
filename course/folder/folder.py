"""Making the learner's folder of a lesson, or of a node; what is there is copied before it changes.

The folders are in `course.lessons.catalog.course_dir`, each named after its lesson. The files of a starter have each
comment in English, and below it in Russian; what they log in English, and behind it `# ru: "..."`.
"""

from __future__ import annotations

import re
import shutil
from dataclasses import dataclass
from pathlib import Path

from course.lessons.catalog import course_dir
from course.lessons.lesson import IGNORED, LessonFolder
from launcher.errors import UsageError
from launcher.profile.defaults import FOLDERS_OWN
from text.i18n import language
from text.sentences import say

NAME = re.compile(r"[a-z][a-z0-9_]*")
_NODE = """\
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
{imports}

class {class_name}(Node):
    def __init__(self):
        super().__init__("{name}")
{body}


def main(args=None):
    rclpy.init(args=args)
    node = {class_name}()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
"""
_TICKS = """\
        self.get_logger().info("{name} is on")
        self.create_timer(1.0, self.tick)

    def tick(self):
        self.get_logger().info("tick")"""
PROFILE = """\
title: {{en: My node, ru: Мой узел}}
nodes:
  {name}:
    run: ./{name}.py
"""
_COMMENTS = re.compile(r"(?:^[ \t]*#.*\n)+", re.MULTILINE)
_RUSSIAN = re.compile("[а-яё]", re.IGNORECASE)
_QUOTED = re.compile('"[^"]*"')
"""Words that the course's nodes know are Russian in every language."""
_DOCSTRING = re.compile(r'"""([^"а-яё]+\.) ([^"]*[а-яё][^"]*)"""', re.IGNORECASE)
_LOGGED = re.compile(r'"([^"\n]*)"\)  # ru: ("[^"\n]*")')


def node_text(name: str, body: str, imports: str = "") -> str:
    """Return the program of a node: `body` is what follows in its class after its own name."""
    class_name = "".join(part.capitalize() for part in name.split("_")) or "MyNode"
    return _NODE.format(name=name, class_name=class_name, body=body, imports=imports)


@dataclass(frozen=True)
class NewFolder:
    """A learner's folder, and what was written into it just now."""

    path: Path
    files: tuple[Path, ...]
    """That were written."""
    kept: tuple[Path, ...]
    """Copies of files that were there and differed."""


def folder_of(lesson: LessonFolder) -> Path:
    """Return where the learner's folder of a lesson is, or would be."""
    return course_dir() / lesson.name


def new_folder(lesson: LessonFolder, *, again: bool = False) -> NewFolder:
    """Make the learner's folder of a lesson from its starter.

    What differs is the learner's. `again` copies it first, mock_sonar.py to mock_sonar.py.1, or .2.

    Raises:
        UsageError: if the lesson has no starter; without `again`, if there are files that differ.
        OSError: if the folder cannot be written.
    """
    folder, texts = folder_of(lesson), _starter(lesson)
    own = [name for name, text in texts.items() if _differs(folder / name, text)]
    if own and not again:
        raise UsageError(
            say(
                "{path} has files of yours already: {files}; nothing was changed. --again begins"
                " anew, and keeps yours as copies",
                path=str(folder),
                files=", ".join(map(str, own)),
            )
        )
    return _written(folder, texts)


def _starter(lesson: LessonFolder) -> dict[Path, Path]:
    if not lesson.starter.is_dir():
        raise UsageError(say("there is no folder {folder}", folder=str(lesson.starter)))
    sources = [file for file in sorted(lesson.starter.rglob("*")) if file.is_file() and not IGNORED & set(file.parts)]
    return {file.relative_to(lesson.starter): file for file in sources}


def _differs(file: Path, source: Path) -> bool:
    return file.exists() and file.read_bytes() != _content(source)


def own_profile(lesson: LessonFolder) -> Path:
    """Return the profile of the learner's folder of a lesson; what is missing there is made.

    Raises:
        UsageError: if the lesson has no starter.
        OSError: if the folder cannot be written.
    """
    profile = folder_of(lesson) / FOLDERS_OWN
    if not profile.is_file():
        folder = folder_of(lesson)
        texts = _starter(lesson).items()
        _written(folder, {name: text for name, text in texts if not (folder / name).exists()})
    return profile


def _written(folder: Path, sources: dict[Path, Path]) -> NewFolder:
    written, kept = [], []
    for name, source in sources.items():
        target = folder / name
        if _differs(target, source):
            kept.append(_copied(target))
        elif target.exists():
            continue
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(_content(source))
        written.append(target)
    return NewFolder(folder, tuple(written), tuple(kept))


def _content(source: Path) -> bytes:
    """Return what the learner gets of a file of the starter."""
    raw = source.read_bytes()
    return in_language(raw, language()) if source.suffix in (".py", ".yaml") else raw


def in_language(content: bytes, code: str) -> bytes:
    """Return the content of a file without the words in the other language."""
    try:
        text = content.decode("utf-8")
    except UnicodeDecodeError:
        return content
    russian = code == "ru"
    text = _DOCSTRING.sub(r'"""\2"""' if russian else r'"""\1"""', text)
    text = _LOGGED.sub(r"\2)" if russian else r'"\1")', text)
    text = _COMMENTS.sub(lambda found: _kept(found[0].splitlines(keepends=True), russian=russian), text)
    return text.encode("utf-8")


def _kept(lines: list[str], *, russian: bool) -> str:
    """Return the lines of a comment in one language; those that have no translation stay."""
    is_russian = [_RUSSIAN.search(_QUOTED.sub("", line)) is not None for line in lines]
    if not russian:
        return "".join(line for line, of_it in zip(lines, is_russian, strict=True) if not of_it)
    kept: list[str] = []
    translated = False
    for line, of_it in zip(reversed(lines), reversed(is_russian), strict=True):
        translated = of_it or translated
        if of_it or not translated:
            kept.append(line)
    return "".join(reversed(kept))


def _copied(file: Path) -> Path:
    """Copy a file to the next free number, and return the copy."""
    number = 1
    while (copy := file.with_name(f"{file.name}.{number}")).exists():
        number += 1
    shutil.copy2(file, copy)
    return copy


def new_node(name: str) -> NewFolder:
    """Make a folder with an empty node of this name and a profile for it.

    Raises:
        UsageError: if the name cannot be one, or if there is such a folder already.
    """
    if not NAME.fullmatch(name):
        raise UsageError(say("{name!r} cannot be the name of a node: write it as my_node", name=name))
    folder = course_dir() / name
    if folder.exists():
        raise UsageError(say("{path} is there already: choose another name", path=str(folder)))
    folder.mkdir(parents=True)
    file, profile = folder / f"{name}.py", folder / FOLDERS_OWN
    file.write_text(node_text(name, _TICKS.format(name=name)), "utf-8")
    profile.write_text(PROFILE.format(name=name), "utf-8")
    return NewFolder(folder, (file, profile), ())
