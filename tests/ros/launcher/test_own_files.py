"""A learner's own node: which Python runs it, what a save does, and how a crash is told."""

from __future__ import annotations

import textwrap
from pathlib import Path

import pytest

from launcher.client.client import SupervisorClient
from launcher.errors import UnknownNodeError, UsageError
from launcher.status import NodeFault, NodeState
from tests.ros.supervised import Launch, said, until_state
from tests.waiting import until
from text.i18n import localized

pytestmark = pytest.mark.nightly

WELL = """\
import time
import rclpy
from std_msgs.msg import Float32
print("knows", rclpy.__name__, "in run", {number}, flush=True)
time.sleep(1000)
"""


def write(file: Path, text: str) -> None:
    file.write_text(textwrap.dedent(text))


async def test_a_save_restarts_it_once_and_a_syntax_error_leaves_it_running(start: Launch, tmp_path: Path) -> None:
    file = tmp_path / "own.py"
    write(file, WELL.format(number=1))
    client = await start({"own": {"exec": ["python", "own.py"]}})
    await until_state(client, "own", NodeState.RUNNING)
    assert await _said(client, "in run 1")
    first = client.nodes["own"].pid
    # As an editor does it that empties the file first, and writes it in pieces.
    text = WELL.format(number=2)
    with file.open("w") as writing:
        for piece in (text[:20], text[20:60], text[60:]):
            writing.write(piece)
            writing.flush()
    assert await _said(client, "in run 2")
    second = client.nodes["own"].pid
    assert second != first
    # By way of another file, which takes its place.
    (tmp_path / "own.py~").write_text("def broken(:\n")
    (tmp_path / "own.py~").replace(file)
    await until(lambda: client.nodes["own"].fault, "the fault is told")
    fault = client.nodes["own"].fault
    assert fault is not None
    assert (fault.kind, fault.line, fault.file) == ("syntax", 1, str(file))
    assert client.nodes["own"].pid == second
    write(file, WELL.format(number=3))
    assert await _said(client, "in run 3")
    assert client.nodes["own"].fault is None
    assert await _starts(client, "own") == 3


NODE = """\
import time
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class Own(Node):
    def __init__(self):
        super().__init__("own")
        {begin}

    def tick(self):
        {tick}


def main():
    rclpy.init()
    node = Own()
    {spin}


{call}
"""
MAIN = """\
if __name__ == "__main__":
    try:
        main()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
"""
TIMER = "self.create_timer(0.05, self.tick)"
SUBSCRIPTION = 'self.create_subscription(String, "/said", lambda m: print(m), 10)'
ACTS = """\
from rclpy.action import ActionClient, ActionServer, CancelResponse
        from example_interfaces.action import Fibonacci
        self.server = ActionServer(self, Fibonacci, "{name}", self.carry_out{cancel})
        self.client = ActionClient(self, Fibonacci, "{name}")
        self.client.wait_for_server()
        self.client.send_goal_async(Fibonacci.Goal())

    def carry_out(self, goal_handle):
        from example_interfaces.action import Fibonacci
        time.sleep(1.0)
        goal_handle.succeed()
        print("carried out", flush=True)
        return Fibonacci.Result()
"""
CANCELS = ", cancel_callback=lambda goal: CancelResponse.ACCEPT"
HASTY = 'self.create_publisher(String, "/said", rclpy.qos.qos_profile_sensor_data)'


def own(begin: str = TIMER, tick: str = "pass", spin: str = "rclpy.spin(node)", call: str = MAIN) -> str:
    return NODE.format(begin=begin, tick=tick, spin=spin, call=call)


async def _fault(client: SupervisorClient, name: str) -> NodeFault:
    found: NodeFault = await until(lambda: client.nodes[name].fault, "the fault is told", 30.0)
    return found


async def test_what_is_wrong_without_an_error_is_told_as_well(start: Launch, tmp_path: Path) -> None:
    """A callback that blocks, a forgotten spin, a main that nobody calls, a QoS that does not fit.

    Each in a node of its own. A callback blocks nothing where there are several threads, nor does
    a goal that nobody may cancel.
    """
    write(tmp_path / "slow.py", own(tick="time.sleep(1.0)"))
    several = "rclpy.spin(node, rclpy.executors.MultiThreadedExecutor(2))"
    write(tmp_path / "pool.py", own(tick='time.sleep(1.0); print("slept", flush=True)', spin=several))
    write(tmp_path / "spinless.py", own(spin="pass"))
    write(tmp_path / "uncalled.py", own(call=""))
    write(tmp_path / "turns.py", own(spin='rclpy.spin(node)\n    rclpy.spin(Node("second"))'))
    write(tmp_path / "hears.py", own(SUBSCRIPTION))
    write(tmp_path / "says.py", own(HASTY))
    write(tmp_path / "drives.py", own(ACTS.format(name="drive", cancel="")))
    write(tmp_path / "cancels.py", own(ACTS.format(name="cancel", cancel=CANCELS)))
    client = await start(
        {
            "slow": {"run": "./slow.py"},
            "pool": {"run": "./pool.py"},
            "spinless": {"run": "./spinless.py"},
            "uncalled": {"exec": ["python", "uncalled.py"]},
            "turns": {"run": "./turns.py"},
            "hears": {"run": "./hears.py"},
            "says": {"run": "./says.py"},
            "drives": {"run": "./drives.py"},
            "cancels": {"run": "./cancels.py"},
        }
    )
    turns = await _fault(client, "turns")
    assert (turns.kind, turns.source_line) == ("warning", 'rclpy.spin(Node("second"))')
    slow = await _fault(client, "slow")
    assert (slow.kind, slow.source_line) == ("warning", "time.sleep(1.0)")
    assert localized(slow.exception, "ru") == "tick не закончил и через 0.7 с"
    assert "let a timer do the waiting" in slow.meaning
    assert client.nodes["slow"].state is NodeState.READY
    assert await _said(client, "slept", "pool")
    assert client.nodes["pool"].fault is None
    assert await _said(client, "carried out", "drives")
    assert client.nodes["drives"].fault is None
    cancels = await _fault(client, "cancels")
    assert "carry_out still runs" in cancels.exception
    assert "let a timer do the waiting" in cancels.meaning
    assert "rclpy.spin(node) is missing" in (await _fault(client, "spinless")).meaning
    assert "rclpy.spin(node) is missing" in client.nodes["spinless"].detail
    assert "main() is never called" in (await _fault(client, "uncalled")).meaning
    assert "QoS" in (await _fault(client, "hears")).meaning


async def test_a_node_is_exchanged_for_ones_own_and_back(start: Launch, tmp_path: Path) -> None:
    write(tmp_path / "decks.py", own())
    write(tmp_path / "mine.py", WELL.format(number="sys.argv[1:]").replace("time", "sys, time", 1))
    client = await start({"own": {"run": "./decks.py", "params": {"period": 2.0}}, "other": {"run": "./decks.py"}})
    await until_state(client, "own", NodeState.READY)
    await client.exchange("own", tmp_path / "mine.py")
    # With the name and the parameters that the profile gives it.
    assert "__node:=own" in await said(client, "own", "knows rclpy in run")
    assert client.nodes["own"].file == str(tmp_path / "mine.py")
    assert client.nodes["own"].command == "./mine.py"
    # From now on it is watched.
    write(tmp_path / "mine.py", WELL.format(number=7))
    assert await _said(client, "in run 7")
    await client.exchange("own", None)
    await until_state(client, "own", NodeState.READY)
    assert client.nodes["own"].file == str(tmp_path / "decks.py")
    await client.exchange("own", "nodes.hello")
    await until(lambda: client.nodes["own"].command == "nodes.hello", "Deck's node")
    await until_state(client, "own", NodeState.READY)
    assert client.nodes["own"].file == ""
    # Stopped by hand, it stays stopped, while another is started again.
    await client.stop("own")
    before = await _starts(client, "own")
    await client.exchange("own", tmp_path / "mine.py")
    await client.exchange("other", tmp_path / "mine.py")
    assert await _said(client, "in run 7", "other")
    assert client.nodes["own"].file == str(tmp_path / "mine.py")
    assert client.nodes["own"].state is NodeState.EXITED
    assert await _starts(client, "own") == before
    with pytest.raises(UsageError, match="no file"):
        await client.exchange("own", tmp_path / "missing.py")
    with pytest.raises(UnknownNodeError):
        await client.exchange("nobody", None)


async def _starts(client: SupervisorClient, node: str) -> int:
    told = [line.text for line in await client.history(node, 500)]
    return sum(text.startswith("started") for text in told)


async def _said(client: SupervisorClient, words: str, node: str = "own") -> bool:
    async def there() -> bool:
        return any(words in line.text for line in await client.history(node, 500))

    return bool(await until(there, f"{node} says {words}"))
