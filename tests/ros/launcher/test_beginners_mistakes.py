"""What beginners get wrong is named by line, and by a sentence that says what it means."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from launcher.faults.crash import crash_of
from launcher.faults.meanings import CHECK_FIELDS, CRASHES, warning_of
from tests.ros.launcher.mistakes import MISTAKES

ROOT = Path(__file__).parents[3]


@pytest.fixture(scope="module")
def printed(
    tmp_path_factory: pytest.TempPathFactory, module_domain: int
) -> dict[str, tuple[list[str], str]]:
    """What each program has printed, and the folder that it was in."""
    folder = tmp_path_factory.mktemp("mistakes")
    names = {f"mistake_{number}": name for number, name in enumerate(MISTAKES)}
    for stem, name in names.items():
        (folder / f"{stem}.py").write_text(MISTAKES[name][0])
    done = subprocess.run(
        [sys.executable, "-m", "tests.ros.launcher.run_mistakes", str(folder)],
        cwd=ROOT,
        env={**os.environ, CHECK_FIELDS: "1", "ROS_DOMAIN_ID": str(module_domain)},
        stdout=subprocess.PIPE,
        text=True,
        check=True,
        timeout=120,
    )
    said: dict[str, str] = json.loads(done.stdout.splitlines()[-1])
    return {names[stem]: (text.splitlines(), str(folder)) for stem, text in said.items()}


@pytest.mark.timeout(150)
@pytest.mark.parametrize("name", MISTAKES)
def test_a_mistake_is_explained(name: str, printed: dict[str, tuple[list[str], str]]) -> None:
    lines, folder = printed[name]
    fault = crash_of(lines, folder)
    assert fault is not None, lines
    assert MISTAKES[name][1] in fault.meaning, fault
    assert fault.file.startswith(folder)
    assert len(fault.exception) < 250, "rclpy writes the limits of a float64 out"
    program = MISTAKES[name][0].splitlines()
    # In the learner's own file, and the line that stands there.
    assert fault.source_line in program[fault.line - 1] or fault.kind == "syntax"


def test_there_are_at_least_thirty() -> None:
    assert len(CRASHES) >= 30
    assert len(MISTAKES) >= 30


def test_what_only_the_log_tells_is_explained() -> None:
    assert "QoS" in warning_of(
        "New publisher discovered on topic '/x', offering incompatible QoS. No messages will be "
        "received from it. Last incompatible policy: RELIABILITY"
    )
    assert "same name" in warning_of("Publisher already registered for provided node name.")
    assert not warning_of("all is well")
