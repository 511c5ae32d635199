"""Direct publishing and calling: what the profile lists, and nothing that moves the robot."""

from __future__ import annotations

import pytest

from agents.raw_access import KEPT, check_call, check_publish
from agents.refusal import RefusedError
from agents.tools import tools_for
from launcher.consent import AgentRules
from robot.safety.moving_topics import MOVING_NAMES

STRING = "std_msgs/msg/String"
TRIGGER = "std_srvs/srv/Trigger"


def test_what_is_listed_is_allowed_and_nothing_else() -> None:
    check_publish("/lamp", STRING, ("lamp",))
    check_call("/lamp_on", TRIGGER, ("/lamp_on",))
    with pytest.raises(RefusedError, match="does not list"):
        check_publish("/lamp2", STRING, ("/lamp",))
    with pytest.raises(RefusedError, match="does not list"):
        check_call("/lamp_off", TRIGGER, ("/lamp_on",))


@pytest.mark.parametrize("topic", sorted(KEPT | MOVING_NAMES))
def test_no_profile_opens_what_moves_or_what_safety_rests_on(topic: str) -> None:
    with pytest.raises(RefusedError, match="may move the robot"):
        check_publish(topic, STRING, (topic,))


@pytest.mark.parametrize(
    "type_name", ["geometry_msgs/msg/Twist", "ackermann_msgs/msg/AckermannDriveStamped"]
)
def test_no_profile_opens_a_type_that_moves(type_name: str) -> None:
    with pytest.raises(RefusedError, match="may move the robot"):
        check_publish("/mine", type_name, ("/mine",))


@pytest.mark.parametrize(
    ("service", "type_name"),
    [
        ("/set_head_position", "x_msgs/srv/X"),
        ("/robot/set_head_position", "x_msgs/srv/X"),
        ("/safety_stop/set_parameters", "rcl_interfaces/srv/SetParameters"),
        ("/mine", "lifecycle_msgs/srv/ChangeState"),
    ],
)
def test_no_profile_opens_the_head_or_the_life_of_nodes(service: str, type_name: str) -> None:
    with pytest.raises(RefusedError):
        check_call(service, type_name, (service,))


def test_the_tools_are_there_only_where_something_is_listed() -> None:
    def names(rules: AgentRules | None) -> set[str]:
        return {tool.name for tool in tools_for(rules)}

    assert {"publish", "call"}.isdisjoint(names(None) | names(AgentRules()))
    assert names(AgentRules(publish=("/lamp",))) - names(AgentRules()) == {"publish"}
    assert names(AgentRules(call=("/lamp_on",))) - names(AgentRules()) == {"call"}
