"""A file of parameters as ROS itself reads it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import rclpy
from rclpy.context import Context

from graph.calls.parameters_file import dump
from graph.data import ParameterRow


def overrides(path: Path, domain: int) -> dict[str, Any]:
    """What a node that is run with this file gets."""
    context = Context()
    rclpy.init(context=context, domain_id=domain)
    node = rclpy.create_node(
        "robot",
        context=context,
        namespace="/arm",
        cli_args=["--ros-args", "--params-file", str(path)],
        allow_undeclared_parameters=True,
        automatically_declare_parameters_from_overrides=True,
        start_parameter_services=False,
    )
    try:
        found: dict[str, Any] = node.get_parameters_by_prefix("")
        return {name: parameter.value for name, parameter in found.items()}
    finally:
        node.destroy_node()
        context.try_shutdown()


def test_ros_reads_what_is_written(tmp_path: Path, ros_domain: int) -> None:
    values: dict[str, tuple[str, Any]] = {
        "speed": ("double", 1e16),
        "tiny": ("double", 1e-300),
        "endless": ("double", float("-inf")),
        "count": ("integer", -(2**63)),
        "on": ("bool", False),
        "frame.name": ("string", "1e5"),
        "frame.y": ("string", "y"),
        "frame.name.deep": ("string", 'quote " back \\ line\nЁж 🦔'),
        "empty": ("string", ""),
        "joints": ("string_array", ["true", "2", "[x]"]),
        "limits": ("double_array", [1.0, 1e-7]),
        "raw": ("byte_array", b"\x00"),
        "unset": ("double", None),
    }
    rows = [ParameterRow(name, kind, value) for name, (kind, value) in values.items()]
    path = tmp_path / "robot.yaml"
    path.write_text(dump("/arm/robot", rows), encoding="utf-8")
    found = overrides(path, ros_domain)
    for name, (kind, value) in values.items():
        if name in {"raw", "unset"}:
            assert name not in found
        else:
            assert (list(found[name]) if kind.endswith("array") else found[name]) == value, name
            assert isinstance(value, list) or type(found[name]) is type(value), name
