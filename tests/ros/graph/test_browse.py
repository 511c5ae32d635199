"""What is installed, and each type down to its fields."""

from __future__ import annotations

import sys
import threading
from typing import TYPE_CHECKING

import pytest

from graph.messages.browse import Constant, definition, interfaces
from graph.messages.types import UnknownTypeError

if TYPE_CHECKING:
    from pathlib import Path


def test_messages_services_and_actions_are_found() -> None:
    names = interfaces()
    assert {
        "std_msgs/msg/Float32",
        "sensor_msgs/msg/Image",
        "ackermann_msgs/msg/AckermannDriveStamped",
        "example_interfaces/srv/AddTwoInts",
        "deck_interfaces/action/DriveToPoint",
    } <= set(names)
    assert list(names) == sorted(set(names))
    assert not any("_Request" in name or "_Goal" in name for name in names)


def test_every_installed_type_has_a_definition_down_to_its_last_field() -> None:
    for name in interfaces():
        for part in definition(name).parts:
            for field in part.fields:
                assert field.message is None or definition(field.message)


def test_a_colcon_workspace_on_the_path_is_found(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    kind = tmp_path / "my_msgs" / "msg"
    kind.mkdir(parents=True)
    lines = "from my_msgs.msg._thing import Thing  # noqa: F401\nimport os\nfrom os import path\n"
    (kind / "__init__.py").write_text(lines)
    monkeypatch.syspath_prepend(str(tmp_path))
    interfaces.cache_clear()
    try:
        assert "my_msgs/msg/Thing" in interfaces()
        monkeypatch.setattr(sys, "path", [str(tmp_path), str(tmp_path / "gone")])
        interfaces.cache_clear()
        assert interfaces() == ("my_msgs/msg/Thing",)
    finally:
        interfaces.cache_clear()


def test_a_message_tells_types_bounds_defaults_and_constants() -> None:
    (part,) = definition("geometry_msgs/msg/Quaternion").parts
    assert [(f.name, f.type_name, f.default) for f in part.fields][3] == ("w", "float64", 1.0)
    (part,) = definition("sensor_msgs/msg/CameraInfo").parts
    fields = {field.name: field for field in part.fields}
    assert (fields["header"].message, fields["header"].type_name) == (
        "std_msgs/msg/Header",
        "std_msgs/Header",
    )
    assert fields["k"].type_name == "float64[9]"
    (part,) = definition("rcl_interfaces/msg/ParameterDescriptor").parts
    bounded = next(field for field in part.fields if field.name == "integer_range")
    assert bounded.type_name == "rcl_interfaces/IntegerRange[<=1]"
    (part,) = definition("diagnostic_msgs/msg/DiagnosticStatus").parts
    assert part.constants[:2] == (Constant("OK", 0), Constant("WARN", 1))
    level = part.fields[0]
    assert (level.type_name, level.least, level.greatest) == ("byte", 0, 255)
    (part,) = definition("std_msgs/msg/Empty").parts
    assert part.fields == ()


def test_services_have_two_parts_and_actions_three() -> None:
    service = definition("rcl_interfaces/srv/ListParameters")
    assert [part.name for part in service.parts] == ["request", "response"]
    assert service.parts[0].constants == (Constant("DEPTH_RECURSIVE", 0),)
    action = definition("deck_interfaces/action/DriveToPoint")
    assert [part.name for part in action.parts] == ["goal", "result", "feedback"]
    assert [field.name for field in action.parts[0].fields] == ["x", "y", "tolerance"]


@pytest.mark.parametrize(
    "name", ["std_msgs/msg/Nope", "nope_msgs/msg/Bool", "std_msgs/Bool", "a/b/c", "", "x/srv/Y"]
)
def test_a_type_that_is_not_there_says_so(name: str) -> None:
    with pytest.raises(UnknownTypeError):
        definition(name)


def test_a_thread_may_ask() -> None:
    found: list[object] = []
    thread = threading.Thread(target=lambda: found.append(definition("std_msgs/msg/Bool")))
    thread.start()
    thread.join(30)
    assert found == [definition("std_msgs/msg/Bool")]
