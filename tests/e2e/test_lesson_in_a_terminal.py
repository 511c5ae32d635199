"""The learner's loop on a real terminal: save, the node is started again, the check is ticked."""

from __future__ import annotations

import json
import shlex
from pathlib import Path

from course.lessons.catalog import SHIPPED
from tests.e2e.conftest import Deck
from tests.hostile_text import EVIL, WORST, harm_on_screen, quoted
from tests.waiting import wait_until

LESSON = "01-hello"
EDITOR = """\
#!/bin/sh
echo "$1" > "{seen}"
cp "{solution}" "$2"
"""
"""An editor that takes its line, and saves the solution."""
NODE = "import rclpy\nrclpy.init()\nrclpy.spin(rclpy.create_node('x'))\n"
ENTITIES = "&#27;]52;c;ZXZpbA==&#7; &#x202e;cba &#155;45m [click](javascript:alert)"
"""What Markdown would make of characters that are not in the file."""


def test_a_saved_file_is_started_again_and_ticks_its_check(deck: Deck, tmp_path: Path) -> None:
    own = Path(deck.env["DECK_COURSE"]) / LESSON / "hello_node.py"
    editor, seen = tmp_path / "vim", tmp_path / "line"
    editor.write_text(EDITOR.format(seen=seen, solution=SHIPPED / LESSON / "solution" / "hello_node.py"))
    editor.chmod(0o755)
    terminal = deck.open(env={"EDITOR": shlex.quote(str(editor))})
    terminal.wait_for("Starts 1 node")
    terminal.press("C")
    terminal.wait_for("1/5 A node that lives")
    starter = own.read_text()
    own.write_text(starter.replace("rclpy.init(args=args)", "rclpy.init(args=args"))
    line = 1 + starter.splitlines().index("    rclpy.init(args=args)")
    terminal.wait_for(f"hello_node.py:{line}: SyntaxError")
    terminal.press("e")
    wait_until(seen.exists, "the editor to be started")
    terminal.wait_for("Passed. Enter goes on.", within_s=60)
    assert seen.read_text() == f"+{line}\n"
    terminal.press("enter")
    terminal.wait_for("2/5 Say hello")
    progress = own.parent.parent / "progress.json"
    assert json.loads(progress.read_text())["lessons"][LESSON]["node"]["passed"]
    terminal.press("f8")
    # The steps that follow pass as well while one looks at them.
    terminal.wait_for(" of 5 steps")
    terminal.wait_for("u Deck's nodes")
    terminal.press("q")
    assert terminal.wait_exit() == 0


def test_a_lesson_that_means_harm_and_a_broken_progress_file_cost_nothing_but_ticks(deck: Deck) -> None:
    course = Path(deck.env["DECK_COURSE"])
    lesson = course / "lessons" / "00-evil"
    own = course / "00-evil"
    for folder in (lesson, lesson / "starter", own):
        folder.mkdir(parents=True)
    (lesson / "lesson.yaml").write_text(
        f"""\
title: {{en: {quoted(WORST)}}}
about: {{en: {quoted(WORST)}}}
nodes: {{talks: {{run: nodes.hello}}}}
steps:
  - id: node
    title: {{en: {quoted(WORST)}}}
    file: talks.py
    checks: [{{topic: /nowhere, type: std_msgs/msg/String, what: {{en: {quoted(WORST)}}}}}]
    hints: [{{en: {quoted(WORST)}}}]
""",
        encoding="utf-8",
    )
    text = f"# {EVIL}\n\nHere it begins {EVIL} {ENTITIES}\n\n## node\n\n```\n{EVIL}\n```\n"
    (lesson / "text.en.md").write_bytes(text.encode("utf-8", "surrogateescape"))
    (own / "lesson.yaml").write_text("nodes: {talks: {run: ./talks.py}}\n")
    (own / "talks.py").write_text(NODE)
    (course / "progress.json").write_text('{"last": "00-evil", "lessons": {"00-evil": [')
    files = {file.name: file.read_text() for file in own.iterdir()}
    terminal = deck.open()
    terminal.wait_for("0/1")
    terminal.press("end", "up")
    terminal.wait_for("0 of 1 step")
    terminal.press("enter")
    terminal.wait_for("Here it begins")
    terminal.press("T")
    terminal.wait_for("Hint 1")
    terminal.wait_for("seen:")
    terminal.press("q")
    assert terminal.wait_exit() == 0
    assert not harm_on_screen(bytes(terminal.kept).decode("utf-8", "surrogateescape"))
    assert {file.name: file.read_text() for file in own.iterdir()} == files
    assert (course / "progress.json.broken").is_file()
    assert json.loads((course / "progress.json").read_text())["last"] == "00-evil"
