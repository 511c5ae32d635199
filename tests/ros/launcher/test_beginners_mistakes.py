"""What beginners get wrong is named by line, and by a sentence that says what it means.

Each program of `tests.ros.launcher.mistakes` is run with the real rclpy. The sentences are written
down in `sentences.txt` there: `--snapshot-update` writes them anew, and they want to be read.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from launcher.faults import CHECK_FIELDS, explain
from launcher.faults.crash import crash_of, warning_of
from launcher.faults.explain import BROKEN
from launcher.faults.failure import Failure
from launcher.faults.rules import RULES
from launcher.faults.source import look_at
from launcher.faults.telling import fault_in, told_in
from launcher.status import NodeFault
from tests.ros.launcher.mistakes import GATE, MISTAKES, TABLE, sentences, write
from tests.ros.launcher.mistakes.programs import script
from text.i18n import localized
from text.sentences import Words

NIGHTLY = pytest.mark.nightly
BYTES = {
    "UTF-16": (script("x = 1").encode("utf-16"), "UTF-16"),
    "UTF-16 without a mark": (script("x = 1").encode("utf-16-le"), "UTF-16"),
    "Windows-1251": (script('x = "привет"').encode("cp1251"), "not stored as UTF-8 (line 18)"),
    "zero byte": (script("x = 1").encode() + b"\0", "zero bytes"),
}
"""Programs that are no text, and words that explain it."""
ROOT = Path(__file__).parents[3]
AT_MOST_S = 600
"""On a busy machine."""
OF_A_LINE = (
    "now of a message's time", "value with brackets", "function of a time", "duration compared",
    "stamps subtracted", "first message not there", "publishers is rclpy's own",
    "fraction for a point", "counted and never made", "array of whole numbers",
    "values without names",
    "square brackets for a vector", "this",
)  # fmt: skip
"""What is told from the part of the line that has failed, where Python tells it."""


def english(fault: NodeFault) -> str:
    return localized(fault.meaning, "en")


@pytest.fixture(scope="module")
def told(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory, module_domain: int
) -> dict[str, tuple[NodeFault | None, str]]:
    """What each program that is asked for has told of its end, and all that it has printed."""
    asked = {item.callspec.params.get("name") for item in _of_this_file(request)}
    chosen = {name: text for name, text in MISTAKES.items() if name in asked}
    return _told(chosen, tmp_path_factory.mktemp("mistakes"), module_domain)


def _of_this_file(request: pytest.FixtureRequest) -> list[Any]:
    items = request.session.items
    return [item for item in items if item.path == request.path and hasattr(item, "callspec")]


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
    )
    said: dict[str, str] = json.loads(done.stdout.splitlines()[-1])
    return {names[stem]: (_fault(text), text) for stem, text in said.items()}


def _fault(printed: str) -> NodeFault | None:
    lines = printed.encode(errors="surrogateescape").split(b"\n")
    found = [fault_in(told) for _before, told in map(told_in, lines) if told]
    return found[-1] if found else None


@pytest.fixture(scope="module")
def expected(told: dict[str, tuple[NodeFault | None, str]], request: pytest.FixtureRequest) -> dict[str, str]:
    if request.config.option.update_snapshots:
        found = {name: english(fault) for name, (fault, _) in told.items() if fault is not None}
        known = sentences() | found
        write({name: known[name] for name in MISTAKES if name in known})
    return sentences()


@pytest.mark.timeout(AT_MOST_S + 30)
@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=() if name in GATE else NIGHTLY, id=name) for name in MISTAKES]
)
def test_a_mistake_is_explained(
    name: str, told: dict[str, tuple[NodeFault | None, str]], expected: dict[str, str]
) -> None:
    """In both languages, with the place in the learner's own file and the line that is there."""
    fault, printed = told[name]
    assert fault is not None, printed
    assert english(fault) == expected[name], fault
    assert any("а" <= letter <= "я" for letter in localized(fault.meaning, "ru"))
    assert BROKEN not in printed
    assert isinstance(fault.meaning, Words)
    assert len(fault.exception) < 250, "rclpy writes the limits of a float64 out"
    assert Path(fault.file).name.startswith("mistake_")
    program = MISTAKES[name].splitlines()
    assert fault.source_line in program[fault.line - 1] or fault.kind == "syntax"
    if name in TABLE["hidden"]:
        return
    # What is read from the printed traceback alone names the same exception.
    read = crash_of(printed.splitlines(), fault.file.rpartition("/")[0])
    assert read is None or fault.exception[:20] in read.exception or fault.kind == "syntax"


@NIGHTLY
@pytest.mark.timeout(AT_MOST_S + 30)
def test_the_line_alone_is_enough(module_domain: int, tmp_path: Path) -> None:
    """As in Python 3.10, which does not tell where in a line something has failed."""
    chosen = {name: MISTAKES[name] for name in OF_A_LINE}
    for name, (fault, printed) in _told(chosen, tmp_path, module_domain, "--lines").items():
        assert fault is not None, printed
        assert english(fault) == sentences()[name], name


def test_there_are_at_least_a_hundred_and_fifty() -> None:
    assert len(MISTAKES) >= 150
    assert set(sentences()) == set(MISTAKES)


def test_a_rule_that_is_broken_is_told_of_and_leaves_the_place(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def broken(_failure: Failure) -> Words | None:
        raise LookupError("no such frame")

    monkeypatch.setattr(explain, "RULES", (broken, *RULES))
    with pytest.raises(ZeroDivisionError) as caught:
        assert 1 / len(())
    fault = explain.explained(caught.value, __file__)
    assert fault.source_line == "assert 1 / len(())"
    assert "is 0 here" in fault.meaning
    assert f"{BROKEN} {__name__}.broken: LookupError: no such frame" in capsys.readouterr().err


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
        "node.py:911: UserWarning: Callback returned an invalid type, it should return SetParameterResult."
    )
    assert not warning_of("all is well")
