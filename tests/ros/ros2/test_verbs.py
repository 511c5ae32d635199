"""Every verb of `ros2` against a real node; what a program could read is pinned to the byte."""

from __future__ import annotations

import contextlib
import re
import signal
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest
import yaml
from std_msgs.msg import Bool

from tests.middleware_words import own_words
from tests.ros.peer import ROOT, Peer
from tests.ros.ros2.typed import typed
from tests.waiting import wait_until

if TYPE_CHECKING:
    from tests.ros.ros2.world import World

pytestmark = pytest.mark.nightly

NUMBER = r"\d+\.\d+"


def out(*words: str) -> str:
    done = typed(*words)
    assert (done.code, done.err) == (0, ""), done
    return done.out


def test_lists_of_the_graph() -> None:
    assert out("node", "list") == "/turtle\n"
    assert out("node", "list", "-c", "--no-daemon") == "1\n"
    names = out("topic", "list").splitlines()
    assert names == sorted(names)
    assert {"/ai_command", "/distance", "/image", "/rosout", "/wheels", "/word"} <= set(names)
    assert not [name for name in names if "/_" in name]
    typed_names = out("topic", "list", "-t", "--include-hidden-topics").splitlines()
    assert "/word [std_msgs/msg/String]" in typed_names
    assert "/fibonacci/_action/status [action_msgs/msg/GoalStatusArray]" in typed_names
    verbose = out("topic", "list", "-v")
    assert verbose.startswith("Published topics:\n * ")
    assert " * /word [std_msgs/msg/String] 1 publisher\n" in verbose
    assert verbose.endswith("\n\nSubscribed topics:\n * /ai_command [std_msgs/msg/String] 1 subscriber\n\n")
    assert "/add [example_interfaces/srv/AddTwoInts]\n" in out("service", "list", "-t")
    assert out("action", "list", "-t") == "/fibonacci [example_interfaces/action/Fibonacci]\n"


def test_topic_info() -> None:
    assert out("topic", "info", "/word") == "Type: std_msgs/msg/String\nPublisher count: 1\nSubscription count: 0\n"
    verbose = re.sub(r"(hash: RIHS01_|GID: )[0-9a-f.]+", r"\1...", out("topic", "info", "-v", "/word"))
    assert verbose == (
        "Type: std_msgs/msg/String\n\nPublisher count: 1\n\n"
        "Node name: turtle\nNode namespace: /\nTopic type: std_msgs/msg/String\n"
        "Topic type hash: RIHS01_...\nEndpoint type: PUBLISHER\nGID: ...\nQoS profile:\n"
        "  Reliability: RELIABLE\n  History (Depth): UNKNOWN\n  Durability: TRANSIENT_LOCAL\n"
        "  Lifespan: Infinite\n  Deadline: Infinite\n  Liveliness: AUTOMATIC\n"
        "  Liveliness lease duration: Infinite\n\nSubscription count: 0\n\n"
    )
    unknown = typed("topic", "info", "/nothing")
    assert (unknown.code, unknown.out, unknown.err) == (1, "", "Unknown topic '/nothing'\n")


def test_node_info() -> None:
    told = out("node", "info", "/turtle")
    lines = told.splitlines()
    assert lines[:4] == [
        "/turtle", "  Subscribers:", "    /ai_command: std_msgs/msg/String", "  Publishers:",
    ]  # fmt: skip
    assert "    /add: example_interfaces/srv/AddTwoInts\n" in told
    assert told.endswith(
        "  Service Clients:\n\n  Action Servers:\n"
        "    /fibonacci: example_interfaces/action/Fibonacci\n  Action Clients:\n\n"
    )
    unknown = typed("node", "info", "/nobody")
    assert (unknown.code, unknown.err) == (1, "Unable to find node '/nobody'\n")


def test_echo() -> None:
    """A latched message arrives; the stamp is cut out, the rest is as it is."""
    assert out("topic", "echo", "--once", "/word") == "data: 'вперёд: ''x'' #1'\n---\n"
    assert out("topic", "echo", "--once", "/word", "--field", "data") == "вперёд: 'x' #1\n---\n"
    wheels = out("topic", "echo", "--once", "/wheels")
    assert re.sub(r"sec: \d+", "sec: T", wheels) == (
        "header:\n  stamp:\n    sec: T\n    nanosec: T\n  frame_id: base_link\n"
        "name:\n- left\n- right\nposition: []\nvelocity:\n- 1.5\n- -0.25\neffort: []\n---\n"
    )
    assert out("topic", "echo", "--once", "/wheels", "--field", "velocity[1]") == "-0.25\n---\n"
    filtered = out("topic", "echo", "--once", "/wheels", "--filter", "m.velocity[1] < 0 and 'left' in m.name")
    assert "velocity:\n- 1.5\n" in filtered
    unknown = typed("topic", "echo", "/wheels", "--filter", "m.speed > 1")
    assert (unknown.code, unknown.out) == (2, "")
    assert unknown.err.startswith("Invalid filter expression 'm.speed > 1': column 1: m.speed: no such field")
    cut = out("topic", "echo", "--once", "/image", "-l", "2", "--qos-reliability", "best_effort")
    assert cut.endswith("data:\n- 0\n- 0\n- '...'\n---\n")
    assert "encoding: rg...\n" in cut


def test_rate() -> None:
    hz = typed("topic", "hz", "/distance", "-w", "10", until="window: 10\n")
    assert hz.code == signal.SIGINT
    found = re.fullmatch(
        rf"(average rate: ({NUMBER})\n\tmin: {NUMBER}s max: {NUMBER}s std dev: \d\.\d{{5}}s "
        r"window: \d+\n)+",
        hz.out,
    )
    assert found, hz.out
    assert 14 < float(found[2]) < 26


def test_pub(world: World) -> None:
    said = out("topic", "pub", "-t", "2", "-r", "50", "/ai_command", "std_msgs/msg/String", "data: вперед")
    said = said.removeprefix("Waiting for at least 1 matching subscription(s)...\n")
    one = "publishing #{}: std_msgs.msg.String(data='вперед')\n\n"
    assert said == "publisher: beginning loop\n" + one.format(1) + one.format(2)
    wait_until(lambda: len(world.heard) >= 2, "both messages")
    assert [message.data for message in world.heard] == ["вперед"] * 2
    wrong = typed("topic", "pub", "/x", "std_msgs/msg/Float32", "{nope: 1}")
    assert wrong.code == 1
    assert wrong.err.startswith("Failed to populate field: ")
    assert typed("topic", "pub", "/x", "std_msgs/msg/Float32", "1").err == (
        "The passed value needs to be a dictionary in YAML format\n"
    )
    stamped = typed(
        "topic", "pub", "/y", "sensor_msgs/msg/JointState", "{header: auto, velocity: [1, 2]}",
        until="publishing #1",
    )  # fmt: skip
    assert stamped.code == signal.SIGINT
    assert re.search(r"sec=[1-9]\d+.*velocity=\[1\.0, 2\.0\]", stamped.out)


def test_a_stop_reaches_all_who_listen_not_only_the_first(module_domain: int) -> None:
    with contextlib.ExitStack() as stack:
        peers = [stack.enter_context(Peer(module_domain, f"listener{n}")) for n in range(5)]
        heard = [peer.hear("/emergency_stop", Bool) for peer in peers]
        out("topic", "pub", "--once", "/emergency_stop", "std_msgs/msg/Bool", "{data: true}")
        wait_until(lambda: all(heard), "the stop at every listener")


def test_service_call() -> None:
    kind = "example_interfaces/srv/AddTwoInts"
    assert out("service", "call", "/add", kind, "{a: 2, b: 5}") == (
        "requester: making request: example_interfaces.srv.AddTwoInts_Request(a=2, b=5)\n\n"
        "response:\nexample_interfaces.srv.AddTwoInts_Response(sum=7)\n\n"
    )
    assert typed("service", "call", "/add", "x/srv/Y").err.startswith("package x is not installed")


def test_parameters() -> None:
    names = out("param", "list", "/turtle").splitlines()
    assert {"  gains", "  name", "  on", "  safe.near", "  speed", "  use_sim_time"} <= set(names)
    assert out("param", "list", "--filter", "speed") == "/turtle:\n  speed\n"
    assert out("param", "list", "/turtle", "--filter", "^on", "--param-type") == ("  on (type: boolean)\n")
    assert out("param", "get", "/turtle", "safe.near") == "Integer value is: 3\n"
    assert out("param", "get", "turtle", "on") == "Boolean value is: True\n"
    assert out("param", "get", "/turtle", "name", "--hide-type") == "лис\n"
    assert out("param", "get", "/turtle", "gains") == "Double values are: array('d', [1.0, 2.5])\n"
    assert out("param", "get", "/turtle", "later") == "Parameter not set.\n"
    assert out("param", "get", "/turtle", "later", "--hide-type") == "None\n"
    assert typed("param", "get", "/turtle", "no").err == "Parameter not set\n"
    assert typed("param", "get", "/nobody", "no").err == "Node not found\n"
    assert out("param", "set", "/turtle", "speed", "0.75") == "Set parameter successful\n"
    refused = typed("param", "set", "/turtle", "name", "''")
    assert (refused.code, refused.out) == (0, "")
    assert refused.err == "Setting parameter failed: a name is needed\n"
    dump = out("param", "dump", "/turtle")
    held = yaml.safe_load(dump)["/turtle"]["ros__parameters"]
    assert (held["speed"], held["safe"], held["gains"]) == (0.75, {"near": 3}, [1.0, 2.5])
    assert out("param", "describe", "/turtle", "speed") == (
        "Parameter name: speed\n  Type: double\n  Description: metres a second\n  Constraints:\n"
        "    Min value: 0.0\n    Max value: 2.0\n"
    )


def test_actions() -> None:
    kind = "example_interfaces/action/Fibonacci"
    assert out("action", "info", "/fibonacci", "-t") == (
        f"Action: /fibonacci\nAction clients: 0\nAction servers: 1\n    /turtle [{kind}]\n"
    )
    sent = out("action", "send_goal", "--feedback", "/fibonacci", kind, "{order: 3}")
    feedback = "Feedback:\n    sequence:\n- 0\n- 1\n- 1\n\n"
    assert sent.count(feedback) == 1
    # A goal that takes no time tells of it before the answer that it is accepted.
    assert re.sub(r"ID: [0-9a-f]{32}", "ID: X", sent.replace(feedback, "")) == (
        "Waiting for an action server to become available...\n"
        "Sending goal:\n     order: 3\n\nGoal accepted with ID: X\n\n"
        "Result:\n    sequence:\n- 0\n- 1\n- 1\n\nGoal finished with status: SUCCEEDED\n"
    )
    assert out("action", "send_goal", "/fibonacci", kind, "{order: -1}").endswith(
        "Sending goal:\n     order: -1\n\nGoal was rejected.\n"
    )
    wrong = typed("action", "send_goal", "/fibonacci", "x/action/Y", "{}")
    assert wrong.code == 1
    assert wrong.err.startswith("package x is not installed")


def test_interfaces() -> None:
    assert out("interface", "show", "geometry_msgs/msg/TwistStamped", "--no-comments") == (
        "std_msgs/Header header\n\tbuiltin_interfaces/Time stamp\n\t\tint32 sec\n"
        "\t\tuint32 nanosec\n\tstring frame_id\nTwist twist\n"
        "\tVector3  linear\n\t\tfloat64 x\n\t\tfloat64 y\n\t\tfloat64 z\n"
        "\tVector3  angular\n\t\tfloat64 x\n\t\tfloat64 y\n\t\tfloat64 z\n"
    )
    assert out("interface", "show", "std_srvs/srv/SetBool") == (
        "bool data # e.g. for hardware enabling / disabling\n---\n"
        "bool success   # indicate successful run of triggered service\n"
        "string message # informational, e.g. for error messages\n"
    )
    assert typed("interface", "show", "nope/msg/No").err == "Unknown package 'nope'\n"


def test_as_a_program_it_ends_quietly() -> None:
    """By Ctrl-C, and where the reader of its output goes first."""
    command = [sys.executable, "-m", "ros2", "topic", "echo", "/distance"]
    with subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as echo:
        assert echo.stdout is not None
        assert next(filter(own_words, echo.stdout)) == "data: 0.25\n"
        echo.send_signal(signal.SIGINT)
        _rest, err = echo.communicate()
        assert (echo.returncode, err) == (signal.SIGINT, "")
    with subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as echo:
        assert echo.stdout is not None
        echo.stdout.readline()
        echo.stdout.close()
        assert echo.stderr is not None
        assert echo.stderr.read() == ""
        assert echo.wait(20) != 0
