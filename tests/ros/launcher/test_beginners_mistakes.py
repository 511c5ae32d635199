"""What beginners get wrong is named by line, and by a sentence that says what it means.

Each program of `tests.ros.launcher.mistakes` is run with the real rclpy. The sentences are written
down in `sentences.txt` there: `--snapshot-update` writes them anew, and they want to be read.
"""

from __future__ import annotations

import ast
import json
import os
import re
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

import pytest

from launcher.faults.crash import crash_of
from launcher.faults.meanings import CHECK_FIELDS, warning_of
from launcher.faults.source import look_at
from launcher.faults.telling import fault_in, told_in
from launcher.status import NodeFault
from tests.ros.launcher.mistakes import MISTAKES, sentences, write
from tests.ros.launcher.mistakes.language import BYTES
from tests.ros.launcher.mistakes.messages import FIELDS
from tests.ros.launcher.mistakes.nodes import HIDDEN
from text.i18n import localized
from text.sentences import Words

pytestmark = pytest.mark.nightly

ROOT = Path(__file__).parents[3]
AT_MOST_S = 600
"""On a busy machine."""
OF_A_LINE = (
    "now of a message's time", "value with brackets", "function of a time", "duration compared",
    "data of a number", "stamps subtracted", "first message not there", "publishers is rclpy's own",
    "first of a map", "fraction for a point", "counted and never made", "array of whole numbers",
    "values without names", "numbers summed one by one", "list and tuple", "number for a point",
    "thread without target", "square brackets for a vector", "text raised", "this",
)  # fmt: skip
"""What is told from the part of the line that has failed, where Python tells it."""


def both(fault: NodeFault) -> tuple[str, str]:
    return localized(fault.meaning, "en"), localized(fault.meaning, "ru")


@pytest.fixture(scope="module")
def told(
    tmp_path_factory: pytest.TempPathFactory, module_domain: int
) -> dict[str, tuple[NodeFault | None, str]]:
    """What each program has told the supervisor of its end, and all that it has printed."""
    return _told(MISTAKES, tmp_path_factory.mktemp("mistakes"), module_domain)


def _told(
    chosen: Mapping[str, str], folder: Path, domain: int, *options: str
) -> dict[str, tuple[NodeFault | None, str]]:
    names = {f"mistake_{number}": name for number, name in enumerate(chosen)}
    for stem, name in names.items():
        (folder / f"{stem}.py").write_text(chosen[name])
    done = subprocess.run(
        [sys.executable, "-m", "tests.ros.launcher.run_mistakes", str(folder), *options],
        cwd=ROOT,
        env={**os.environ, CHECK_FIELDS: "1", "ROS_DOMAIN_ID": str(domain)},
        stdout=subprocess.PIPE,
        text=True,
        check=True,
        timeout=AT_MOST_S,
    )
    said: dict[str, str] = json.loads(done.stdout.splitlines()[-1])
    return {names[stem]: (_fault(text), text) for stem, text in said.items()}


def _fault(printed: str) -> NodeFault | None:
    lines = printed.encode(errors="surrogateescape").split(b"\n")
    found = [fault_in(told) for _before, told in map(told_in, lines) if told]
    return found[-1] if found else None


@pytest.fixture(scope="module")
def expected(
    told: dict[str, tuple[NodeFault | None, str]], request: pytest.FixtureRequest
) -> dict[str, tuple[str, str]]:
    if request.config.option.update_snapshots:
        write({name: both(fault) for name in MISTAKES if (fault := told[name][0]) is not None})
    return sentences()


@pytest.mark.timeout(AT_MOST_S + 30)
@pytest.mark.parametrize("name", MISTAKES)
def test_a_mistake_is_explained(
    name: str,
    told: dict[str, tuple[NodeFault | None, str]],
    expected: dict[str, tuple[str, str]],
) -> None:
    """In both languages, with the place in the learner's own file and the line that is there."""
    fault, printed = told[name]
    assert fault is not None, printed
    assert both(fault) == expected[name], fault
    assert isinstance(fault.meaning, Words)
    assert len(fault.exception) < 250, "rclpy writes the limits of a float64 out"
    assert Path(fault.file).name.startswith("mistake_")
    program = MISTAKES[name].splitlines()
    assert fault.source_line in program[fault.line - 1] or fault.kind == "syntax"
    if name in HIDDEN:
        return
    # What is read from the printed traceback alone names the same exception.
    read = crash_of(printed.splitlines(), fault.file.rpartition("/")[0])
    assert read is None or fault.exception[:20] in read.exception or fault.kind == "syntax"


@pytest.mark.timeout(AT_MOST_S + 30)
def test_the_line_alone_is_enough(module_domain: int, tmp_path: Path) -> None:
    """As in Python 3.10, which does not tell where in a line something has failed."""
    chosen = {name: MISTAKES[name] for name in OF_A_LINE}
    for name, (fault, printed) in _told(chosen, tmp_path, module_domain, "--lines").items():
        assert fault is not None, printed
        assert both(fault) == sentences()[name], name


@pytest.mark.timeout(AT_MOST_S + 30)
def test_what_a_sentence_says_to_write_mends_the_line(module_domain: int, tmp_path: Path) -> None:
    """Of each field that was given a wrong value: with the expression of the sentence it runs."""
    found = {name: _mended(FIELDS[name], sentences()[name][0]) for name in FIELDS}
    chosen = {name: program for name, program in found.items() if program}
    assert len(chosen) >= 20
    for name, (fault, printed) in _told(chosen, tmp_path, module_domain).items():
        assert fault is None, (name, chosen[name].splitlines()[-4:], printed)


def _mended(program: str, sentence: str) -> str:
    """Return the program with the expression that the sentence makes of what was given."""
    for node in ast.walk(ast.parse(program)):
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Attribute):
            given = ast.unparse(node.value)
            line = program.splitlines()[node.lineno - 1]
            expression = _around(sentence, given)
            if expression and node.targets[0].attr != "last":
                made = f"{ast.unparse(node.targets[0])} = {expression}"
                return program.replace(line.strip(), made)
    return ""


def _around(sentence: str, given: str) -> str:
    """Return the first call or list in a sentence with the given expression in it."""
    begins = [found.start() for found in re.finditer(r"(?<= )(?!write )\S", sentence)]
    for begin in begins:
        ends = [found.end() for found in re.finditer(r"[\])]|\d(?=[.,]?(?: |$))", sentence[begin:])]
        parts = [sentence[begin : begin + end] for end in ends[::-1]]
        for part in parts:
            is_more = given in part and part not in (given, f"({given})") and ". " not in part
            if is_more and _is_expression(part):
                return part
    return ""


def _is_expression(text: str) -> bool:
    try:
        return not isinstance(ast.parse(text, mode="eval").body, (ast.Tuple, ast.Compare))
    except SyntaxError:
        return False


def test_there_are_at_least_a_hundred_and_fifty() -> None:
    assert len(MISTAKES) >= 150
    assert set(sentences()) == set(MISTAKES)
    russian = [ru for _en, ru in sentences().values()]
    assert all(any("а" <= letter <= "я" for letter in words) for words in russian)


@pytest.mark.parametrize("name", BYTES)
def test_a_file_that_is_not_text_is_explained(name: str, tmp_path: Path) -> None:
    file = tmp_path / "own.py"
    file.write_bytes(BYTES[name][0])
    fault = look_at(str(file))
    assert fault is not None
    assert BYTES[name][1] in fault.meaning


def test_what_only_the_log_tells_is_explained() -> None:
    assert "QoS" in warning_of(
        "New publisher discovered on topic '/x', offering incompatible QoS. No messages will be "
        "received from it. Last incompatible policy: RELIABILITY"
    )
    assert "same name" in warning_of("Publisher already registered for provided node name.")
    assert "SetParametersResult" in warning_of(
        "node.py:911: UserWarning: Callback returned an invalid type, it should return"
        " SetParameterResult."
    )
    assert not warning_of("all is well")
