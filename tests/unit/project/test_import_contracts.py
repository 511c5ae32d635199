"""Who may import whom: the contracts of pyproject.toml hold back what they should."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests.rooms import PYPROJECT, ROOMS

ROOT = Path(__file__).parents[3]
LINTER = "from importlinter.cli import lint_imports_command; lint_imports_command()"
IGNORED = re.compile(r'"([\w.]+) -> ([\w.]+)"')
"""An exception of a contract, which the linter expects to find."""

ALLOWED = {
    "deck": ["cli.main"],
    "cli.run": ["graph", "launcher", "robot", "text", "tui.settings"],
    "tui.app": ["graph", "launcher", "robot", "text", "textual", "rich"],
    "graph.observer.observer": ["rclpy", "std_msgs.msg", "numpy", "text", "yaml"],
    "nodes.hello": ["rclpy", "robot", "text", "cv2", "example_interfaces.srv"],
    "launcher.profile.load": [
        "asyncio",
        "psutil",
        "pydantic",
        "text",
        "yaml",
    ],
    "launcher.supervisor.run": ["launcher.spawn_server.start"],
    "launcher.spawn_server.server": ["launcher.spawn_server.node", "launcher.spawn_server.preload"],
    "launcher.spawn_server.node": ["launcher.spawn_server.probe"],
    "launcher.spawn_server.probe": ["rclpy", "launcher.spawn_server.message_rates"],
    "launcher.spawn_server.message_rates": ["rclpy"],
    "launcher.spawn_server.start": ["launcher.spawn_server.server", "socket"],
    "launcher.spawn_server.preload": ["ctypes"],
    "robot.commands.schema": ["math", "numpy", "pydantic", "text"],
    "text.plain": ["re", "yaml"],
}

FORBIDDEN = {
    "deck": ["graph", "launcher", "nodes", "robot", "text", "tui"],
    "cli.run": ["deck", "nodes", "rclpy", "textual"],
    "tui.app": ["cli", "deck", "nodes", "rclpy", "sensor_msgs.msg"],
    "graph.observer.observer": ["launcher", "nodes", "robot", "textual", "tui"],
    "nodes.hello": ["graph", "launcher", "textual", "tui"],
    "launcher.profile.load": [
        *("graph", "nodes", "rclpy", "std_msgs.msg", "textual", "tui"),
        *(
            "launcher.spawn_server.server",
            "launcher.spawn_server.probe",
            "launcher.spawn_server.preload",
        ),
    ],
    "robot.commands.schema": [
        "asyncio",
        "graph",
        "launcher",
        "nodes",
        "rclpy",
        "subprocess",
        "tui",
    ],
    "text.plain": ["graph", "launcher", "nodes", "rclpy", "robot", "textual", "tui"],
}


def lint(tree: Path, *more: dict[str, list[str]]) -> subprocess.CompletedProcess[str]:
    """Write the modules of the rooms with these imports alone, and run the linter on them."""
    for module in (path for room in ROOMS for path in (ROOT / room).rglob("*.py")):
        copy = tree / module.relative_to(ROOT)
        copy.parent.mkdir(parents=True, exist_ok=True)
        copy.touch()
    exceptions = [{module: [name]} for module, name in IGNORED.findall(PYPROJECT.read_text())]
    for imports in (ALLOWED, *exceptions, *more):
        for module, names in imports.items():
            path = tree / module.replace(".", "/")
            with (path / "__init__.py" if path.is_dir() else path.with_suffix(".py")).open(
                "a"
            ) as source:
                source.writelines(f"import {name}\n" for name in names)
    return subprocess.run(
        [sys.executable, "-c", LINTER, "--config", str(PYPROJECT), "--no-cache"],
        cwd=tree,
        env={"PYTHONPATH": str(tree), "_ROS_WHEELS_BOOTSTRAP_COMPLETE": "1"},
        capture_output=True,
        text=True,
        check=False,
    )


def test_what_the_rooms_need_is_allowed(tmp_path: Path) -> None:
    linted = lint(tmp_path)
    assert linted.returncode == 0, linted.stdout + linted.stderr


@pytest.fixture(scope="module")
def broken(tmp_path_factory: pytest.TempPathFactory) -> set[tuple[str, str]]:
    """The imports that the linter refuses in a tree that does all that is forbidden."""
    linted = lint(tmp_path_factory.mktemp("broken"), FORBIDDEN)
    assert linted.returncode == 1, linted.stdout + linted.stderr
    return set(re.findall(r"([\w.]+) -> ([\w.]+) \(l\.", linted.stdout))


@pytest.mark.parametrize(
    ("module", "name"), [(module, name) for module, names in FORBIDDEN.items() for name in names]
)
def test_what_a_room_must_not_know_is_refused(
    broken: set[tuple[str, str]], module: str, name: str
) -> None:
    outside = name.split(".", maxsplit=1)[0] not in ROOMS
    assert (module, name.split(".", maxsplit=1)[0] if outside else name) in broken
