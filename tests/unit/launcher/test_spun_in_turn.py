"""Of two nodes that are spun one after the other, the second one never runs: it is told which."""

from __future__ import annotations

from pathlib import Path

import pytest

from launcher.faults.source import spun_in_turn

BEGIN = "import rclpy\n"


@pytest.mark.parametrize(
    ("program", "line"),
    [
        ("rclpy.spin(a)\nrclpy.spin(b)\n", 3),
        ("def main():\n    rclpy.init()\n    rclpy.spin(a)\n    rclpy.spin(b)\nmain()\n", 5),
        ("try:\n    rclpy.spin(A())\n    rclpy.spin(B())\nfinally:\n    rclpy.shutdown()\n", 4),
        ("try:\n    rclpy.spin(a)\nexcept KeyboardInterrupt:\n    pass\nrclpy.spin(b)\n", 6),
        ("for node in (a, b):\n    print(node)\n    rclpy.spin(node)\n", 4),
        ("from rclpy import spin\nspin(a)\nspin(b)\n", 4),
    ],
)
def test_the_line_whose_turn_does_not_come_is_named(program: str, line: int, tmp_path: Path) -> None:
    (tmp_path / "own.py").write_text(BEGIN + program)
    fault = spun_in_turn(str(tmp_path / "own.py"))
    assert fault is not None
    assert (fault.kind, fault.line) == ("warning", line)
    assert fault.source_line.startswith(("rclpy.spin(", "spin("))


@pytest.mark.parametrize(
    "program",
    [
        "rclpy.spin(a)\n",
        "rclpy.spin_once(a)\nrclpy.spin(b)\n",
        "if x:\n    rclpy.spin(a)\nelse:\n    rclpy.spin(b)\n",
        "rclpy.spin(a)\nrclpy.shutdown()\nrclpy.init()\nrclpy.spin(b)\n",
        "def one():\n    rclpy.spin(a)\ndef two():\n    rclpy.spin(b)\n",
        "for again in range(3):\n    rclpy.spin(a)\n",
        "rclpy.spin(a, executor)\nrclpy.spin(b, executor)\n",
        "rclpy.spin(",
    ],
)
def test_what_has_its_turn_is_not_named(program: str, tmp_path: Path) -> None:
    (tmp_path / "own.py").write_text(BEGIN + program)
    assert spun_in_turn(str(tmp_path / "own.py")) is None
