"""`ros2 lifecycle` and `ros2 component` against real nodes: what is printed, and the exit code."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from lifecycle_msgs.srv import GetState

from tests.ros.managed_nodes import started
from tests.ros.ros2.typed import typed
from tests.waiting import wait_until

if TYPE_CHECKING:
    from collections.abc import Iterator

    from tests.ros.ros2.world import World

pytestmark = pytest.mark.nightly

NODES = "/good\n/hanging\n/hopeless\n/raising\n/refusing\n"


@pytest.fixture(autouse=True, scope="module")
def _managed(module_domain: int) -> Iterator[None]:
    with started(module_domain):
        yield


@pytest.fixture(autouse=True)
def _all_there(_managed: None, _in_its_domain: None) -> None:
    """Whichever test is the first waits for their program to start."""
    wait_until(lambda: typed("lifecycle", "nodes").out == NODES, "their program to start")


def out(*words: str) -> str:
    done = typed(*words)
    assert (done.code, done.err) == (0, ""), done
    return done.out


def failed(*words: str) -> str:
    done = typed(*words)
    assert (done.code, done.out) == (1, ""), done
    return done.err


def test_nodes_with_a_lifecycle_are_listed_and_not_who_is_only_called(world: World) -> None:
    world.node.create_client(GetState, "/nobody/get_state")
    assert out("lifecycle", "nodes") == NODES
    assert out("lifecycle", "nodes", "-c") == "5\n"


def test_states_are_got_and_transitions_made() -> None:
    assert out("lifecycle", "get", "/good") == "unconfigured [1]\n"
    assert out("lifecycle", "list", "good") == (
        "- configure [1]\n\tStart: unconfigured\n\tGoal: configuring\n"
        "- shutdown [5]\n\tStart: unconfigured\n\tGoal: shuttingdown\n"
    )
    assert "- deactivate [4]\n\tStart: active\n" in out("lifecycle", "list", "good", "-a")
    assert out("lifecycle", "set", "/good", "configure") == "Transitioning successful\n"
    assert out("lifecycle", "set", "good", "3") == "Transitioning successful\n"
    states = ["/good: active [3]", *(f"{name}: unconfigured [1]" for name in NODES.split()[1:])]
    assert out("lifecycle", "get").splitlines() == states


def test_who_is_not_there_is_not_waited_for_long() -> None:
    assert failed("lifecycle", "get", "/nobody") == "Node not found\n"
    assert failed("lifecycle", "set", "/nobody", "configure") == "Node not found\n"
    assert failed("component", "list", "/good") == "Unable to find container node '/good'\n"


def test_what_fails_says_so_to_a_script() -> None:
    assert failed("lifecycle", "set", "/refusing", "configure") == "Transitioning failed\n"
    assert failed("lifecycle", "set", "/refusing", "activate") == (
        "Unknown transition requested, available ones are:\n- configure [1]\n- shutdown [5]\n"
    )
    assert typed("lifecycle", "set", "/good").code == 2
    assert typed("component", "unload", "/arm/container", "1").code == 2


def test_components_are_listed_below_their_container() -> None:
    assert out("component", "list") == "/arm/container\n  2  /arm/gripper\n  1  /good\n"
    assert out("component", "list", "/arm/container") == "2  /arm/gripper\n1  /good\n"
    only = out("component", "list", "--containers-only")
    assert only == "/arm/container\n"
