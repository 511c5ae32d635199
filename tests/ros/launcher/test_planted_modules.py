"""What lies in the current folder is not taken for a part of Deck, of ROS or of a library."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.middleware_words import own_words
from tests.unit.profile_files import written
from tests.waiting import DEADLINE_S

pytestmark = pytest.mark.nightly

PLANTED = (
    *("nodes/__init__.py", "nodes/hello.py", "nodes/parts/runner.py", "launcher/__init__.py"),
    *("launcher/supervisor/__main__.py", "rclpy/__init__.py", "std_msgs/__init__.py", "tui/app.py"),
    *("graph/__init__.py", "numpy.py", "yaml.py", "json.py", "psutil.py", "sitecustomize.py"),
    *("usercustomize.py", "cli/main.py", "text/__init__.py", "robot/__init__.py", "runpy.py"),
    "cv2.py",
)
SCRIPT = [str(Path(sys.executable).with_name("deck"))]
MODULES = [[sys.executable, "-m", "tui"], [sys.executable, "-m", "deck"]]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with modules that tell when they are run."""
    folder = tmp_path / "downloads"
    for name in PLANTED:
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f"open({str(tmp_path / 'taken')!r}, 'a').write(__file__ + '\\n')\n")
    return folder


@pytest.fixture
def domain(ros_domain: int) -> int:
    return ros_domain


def deck(folder: Path, command: list[str], *words: str, **environ: str) -> str:
    """Run `deck` there to its end; return what it has written."""
    done = subprocess.run(
        [*command, *words],
        cwd=folder,
        env={**os.environ, **environ},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
        timeout=DEADLINE_S,
    )
    return own_words(done.stdout)


def taken(folder: Path) -> str:
    """Which planted modules were run."""
    path = folder.parent / "taken"
    return path.read_text() if path.exists() else ""


@pytest.mark.usefixtures("domain")
@pytest.mark.parametrize("warm", ["true", "false"])
def test_shipped_nodes_come_from_the_installation(folder: Path, warm: str) -> None:
    profile = written(folder, f"nodes: {{hello: {{run: nodes.hello, warm: {warm}}}}}")
    said = deck(folder, SCRIPT, "run", str(profile), "--for", "1.5")
    assert taken(folder) == ""
    assert "[hello]" in said


@pytest.mark.usefixtures("domain")
def test_the_empty_part_of_a_python_path_is_not_the_current_folder(folder: Path) -> None:
    """`export PYTHONPATH=$PYTHONPATH:/more` leaves one behind; Deck's processes do not mind."""
    profile = written(folder, "nodes: {hello: {run: nodes.hello, warm: false}}")
    started = folder.parent / "elsewhere"
    started.mkdir()
    text = profile.read_text().replace("warm:", f"cwd: {folder}, warm:")
    profile.write_text(text)
    said = deck(started, SCRIPT, "run", str(profile), "--for", "1.5", PYTHONPATH=":/nowhere")
    assert taken(folder) == ""
    assert "[hello]" in said


@pytest.mark.parametrize("command", [SCRIPT, *MODULES])
@pytest.mark.parametrize("words", [("check", "01-hello"), ("list",), ("doctor",), ("ps",)])
def test_no_command_takes_what_lies_in_the_current_folder(
    folder: Path, command: list[str], words: tuple[str, ...]
) -> None:
    if command in MODULES:
        # Python itself looks for the package `tui` there, and is asked to.
        shutil.rmtree(folder / "tui")
    deck(folder, command, *words)
    assert taken(folder) == ""


@pytest.mark.usefixtures("domain")
@pytest.mark.parametrize("warm", ["true", "false"])
def test_a_node_of_ones_own_is_run_from_the_folder_of_its_profile(
    tmp_path: Path, warm: str
) -> None:
    """By its path, from wherever Deck is started; what lies beside it can be imported."""
    lesson, start = tmp_path / "lesson", tmp_path / "start"
    (lesson / "parts").mkdir(parents=True)
    start.mkdir()
    (lesson / "parts" / "beside_it.py").write_text("WORD = 'beside'\n")
    (lesson / "parts" / "my_sonar.py").write_text(
        "import os, sys\n"
        "import rclpy\n"
        "from beside_it import WORD\n"
        "import nodes\n"
        "rclpy.init()\n"
        "node = rclpy.create_node('anything')\n"
        "print('told', WORD, node.get_name(), __name__, os.getcwd(), sys.argv[0])\n"
        "rclpy.spin(node)\n"
    )
    base = written(lesson, f"nodes: {{a: {{run: ./parts/my_sonar.py, warm: {warm}}}}}", "base.yaml")
    written(start, f"extends: {base}", "mine.yaml")
    said = deck(start, SCRIPT, "run", "mine.yaml", "--for", "2")
    file = lesson / "parts" / "my_sonar.py"
    assert f"told beside a __main__ {start} {file}" in said


@pytest.mark.usefixtures("domain")
@pytest.mark.parametrize("warm", ["true", "false"])
def test_a_node_of_ones_own_gets_what_others_have_installed_under_a_name_of_decks(
    tmp_path: Path, warm: str
) -> None:
    names = ("graph", "text", "nodes", "launcher")
    for name in names:
        (tmp_path / "installed" / name).mkdir(parents=True)
        (tmp_path / "installed" / name / "__init__.py").write_text("WHOSE = 'mine'\n")
    (tmp_path / "my_node.py").write_text(
        f"import {', '.join(names)}\n"
        "import robot.kinematics\n"
        f"print('told', {', '.join(f'{name}.WHOSE' for name in names)})\n"
        "import rclpy\n"
        "rclpy.init()\n"
        "rclpy.spin_once(rclpy.create_node('anything'), timeout_sec=0.1)\n"
        "__import__('time').sleep(60)\n"
    )
    text = f"{{a: {{run: ./my_node.py, warm: {warm}}}, hello: {{run: nodes.hello, warm: {warm}}}}}"
    profile = written(tmp_path, f"nodes: {text}")
    path = str(tmp_path / "installed")
    said = deck(tmp_path, SCRIPT, "run", str(profile), "--for", "3", PYTHONPATH=path)
    assert "told mine mine mine mine" in said
    assert "[hello]" in said
    assert "Error" not in said
