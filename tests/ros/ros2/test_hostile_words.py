"""What others publish, answer or are set to is printed so that it can be read, and does nothing."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import pytest
import yaml
from geometry_msgs.msg import TransformStamped
from rcl_interfaces.msg import ParameterDescriptor
from sensor_msgs.msg import JointState
from std_msgs.msg import Header, String
from std_srvs.srv import SetBool
from tf2_ros import Buffer

from ros2 import naming
from ros2.printing import to_yaml
from tests.hostile_text import EVIL, harm_in
from tests.ros.peer import LATCHED
from tests.ros.ros2.typed import Typed, typed

if TYPE_CHECKING:
    from collections.abc import Iterator

    from tests.ros.ros2.world import World

NAME = "safe \u202egpj.exe"
SHOWN = "safe \N{REPLACEMENT CHARACTER}gpj.exe"


@pytest.fixture(scope="module")
def _evil(world: World) -> Iterator[None]:
    world.publisher("/evil", String, LATCHED).publish(String(data=NAME + EVIL))
    described = ParameterDescriptor(description=NAME + EVIL)
    world.node.declare_parameter("evil", NAME + EVIL, described)
    service = world.node.create_service(SetBool, "/evil_answer", _answer)
    yield
    world.node.destroy_service(service)
    world.node.undeclare_parameter("evil")


def _answer(_request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
    response.message = NAME + EVIL
    return response


@pytest.mark.usefixtures("_evil")
@pytest.mark.parametrize(
    "words",
    [
        ("topic", "echo", "--once", "/evil"),
        ("topic", "echo", "--once", "/evil", "--flow-style"),
        ("topic", "echo", "--once", "/evil", "--csv"),
        ("topic", "echo", "--once", "/evil", "--field", "data"),
        ("param", "get", "/turtle", "evil"),
        ("param", "get", "/turtle", "evil", "--hide-type"),
        ("param", "describe", "/turtle", "evil"),
        ("param", "dump", "/turtle"),
    ],
    ids=" ".join,
)
def test_what_others_wrote_is_shown_as_on_the_screens(words: tuple[str, ...]) -> None:
    shows(typed(*words), escapes=words[1] == "dump" or words[-1] in ("/evil", "--flow-style"))


@pytest.mark.usefixtures("_evil")
def test_what_a_service_answers_is_shown_as_on_the_screens() -> None:
    # Python's own form has escapes for all that cannot be seen.
    shows(typed("service", "call", "/evil_answer", "std_srvs/srv/SetBool", "{}"), escapes=True)


FORGED = "odom\n[ERROR] [1.0] [chassis]: the brake has failed"


def test_no_name_begins_a_line_of_its_own() -> None:
    """Whoever is no node of ROS may have any name, and who publishes any frame."""
    (topic,) = naming.shown([(f"/{FORGED}", [FORGED])], hidden=True)
    assert "\n" not in topic[0] + topic[1][0]
    header = to_yaml(Header(frame_id=FORGED))
    assert [line.partition(":")[0] for line in header.splitlines()] == [
        "stamp", "  sec", "  nanosec", "frame_id",
    ]  # fmt: skip
    assert yaml.safe_load(header)["frame_id"] == FORGED
    assert to_yaml(JointState(name=[FORGED])).count("[ERROR]") == 1
    assert not re.search(r"^\W*\[ERROR\]", to_yaml(JointState(name=[FORGED])), re.MULTILINE)
    # A text that stands for itself may be a page.
    assert to_yaml(String(data="a\nb")).count("\n") > 1
    buffer = Buffer()
    frame = TransformStamped(header=Header(frame_id=FORGED), child_frame_id=f"b{FORGED}")
    frame.transform.rotation.w = 1.0
    buffer.set_transform(frame, "somebody")
    assert buffer.all_frames_as_string().count("\n") == 1


def shows(told: Typed, *, escapes: bool = False) -> None:
    assert (told.code, told.err) == (0, "")
    # A tab does nothing, and the real tool prints some of its own.
    assert harm_in(told.out.replace("\t", "").encode("utf-8", "surrogatepass")) == []
    assert "gpj.exe" in told.out
    assert escapes or SHOWN in told.out
