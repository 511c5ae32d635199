"""A node that runs is at work: no callback is stuck, no thread has died; others are told."""

from __future__ import annotations

import textwrap
from pathlib import Path

import pytest

from cli.health import well
from launcher.client.client import SupervisorClient
from launcher.status import STUCK, THREAD, NodeFault, NodeState, Severity
from tests.middleware_words import own_words
from tests.ros.supervised import Launch
from tests.waiting import until

pytestmark = pytest.mark.nightly

NODE = """\
import threading
import time
import rclpy
from example_interfaces.action import Fibonacci
from rclpy.action import ActionClient
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.node import Node
from std_srvs.srv import Trigger


class Own(Node):
    def __init__(self):
        super().__init__("own")
        self.client = self.create_client(
            Trigger, "own_service", callback_group=self.group()
        )
        self.create_service(Trigger, "own_service", self.answer, callback_group=self.group())
        self.nobody = self.create_client(Trigger, "nobody")
        self.action = ActionClient(self, Fibonacci, "count")
        self.rate = self.create_rate(1)
        self.count = 0
        self.create_timer(0.1, self.tick)
        {begin}

    def group(self):
        return {group}

    def answer(self, request, response):
        return response

    def work(self):
        {work}

    {define} tick(self):
        self.count += 1
        {tick}


rclpy.init()
{main}
"""
SPIN = "rclpy.spin(Own())"
IN_TWO_THREADS = """
from rclpy.executors import MultiThreadedExecutor
executor = MultiThreadedExecutor(2)
node = Own()
executor.add_node(node)
executor.spin()"""
PUBLISHES = """
from std_msgs.msg import String
node = rclpy.create_node("own")
publisher = node.create_publisher(String, "said", 10)
while True:
    publisher.publish(String(data="on"))
    time.sleep(0.5)"""
SPINS_NOW_AND_THEN = """
node = Own()
while True:
    rclpy.spin_once(node, timeout_sec=0)
    time.sleep(0.5)"""
IN_EVERY_THREAD = """
        from rclpy.callback_groups import ReentrantCallbackGroup
        self.shared = ReentrantCallbackGroup()
        self.ours = self.create_client(Trigger, "own_service", callback_group=self.shared)
        self.create_timer(0.1, self.ask, callback_group=self.shared)

    def ask(self):
        time.sleep(0.3)
        self.ours.call(Trigger.Request())"""
DEBUGGED = """
        import io, pdb, sys
        commands = io.StringIO("self.client.call(Trigger.Request())\\n")
        pdb.Pdb(stdin=commands, stdout=sys.stdout, readrc=False).set_trace()
        pass"""
STOPPED = """
        if self.count > 1:
            print("went on", flush=True) if self.count == 2 else None
            return
        import os, signal, subprocess
        def answer():
            for future in list(self.client._pending_requests.values()):
                future.set_result(Trigger.Response())
        threading.Timer(5.0, answer).start()
        subprocess.Popen(["sh", "-c", f"sleep 4; kill -CONT {os.getpid()}"])
        threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGSTOP)).start()
        self.client.call(Trigger.Request())"""
SPUN = """
        future = self.client.call_async(Trigger.Request())
        rclpy.spin_until_future_complete(self, future)"""
ASKS = "future = self.client.call_async(Trigger.Request())"
POLLS = f"""
        {ASKS}
        while not future.done():
            time.sleep(0.05)"""
EVENT = f"""
        event = threading.Event()
        {ASKS}
        future.add_done_callback(lambda _: event.set())
        event.wait()"""
GOAL = """
        future = self.action.send_goal_async(Fibonacci.Goal(order=3))
        rclpy.spin_until_future_complete(self, future)"""
TURNS = """
        future = self.nobody.call_async(Trigger.Request())
        while not future.done():
            rclpy.spin_once(self, timeout_sec=0.1)"""
TOO_EARLY = """
        future = self.create_client(Trigger, "too_late").call_async(Trigger.Request())
        offer = (Trigger, "too_late", self.answer)
        threading.Timer(2.0, self.create_service, offer).start()
        rclpy.spin_until_future_complete(self, future)"""
PATIENT = """
        late = self.create_client(Trigger, "late_service")
        while not late.wait_for_service(timeout_sec=1.0):
            pass
        future = late.call_async(Trigger.Request())
        rclpy.spin_until_future_complete(self, future)
        print("went on", flush=True)"""
LATE = """
time.sleep(3.0)
node = Own()
node.create_service(Trigger, "late_service", node.answer)
rclpy.spin(node)"""
SENDS = """
        self.action.send_goal_async(Fibonacci.Goal(order=3)).add_done_callback(print)"""
BUSY = """
        if self.count == 1:
            end = time.monotonic() + 5.0
            while time.monotonic() < end:
                pass
        elif self.count == 3:
            print("went on", flush=True)"""


def own(**parts: str) -> str:
    usual = {"begin": "pass", "work": "pass", "tick": "pass", "main": SPIN}
    return textwrap.dedent(NODE).format(**{**usual, "group": "None", "define": "def", **parts})


async def _ailing(client: SupervisorClient, name: str, kind: str, meaning: str = "") -> NodeFault:
    def found() -> NodeFault | None:
        fault = client.nodes[name].fault
        of_it = fault is not None and fault.kind == kind and meaning in fault.meaning
        return fault if of_it else None

    fault: NodeFault = await until(found, lambda: f"{name} ails: {client.nodes[name]}", 60.0)
    return fault


async def test_who_is_stuck_or_has_lost_a_thread_is_not_healthy(start: Launch, tmp_path: Path) -> None:
    """A callback that waits for itself; one that only works for long is none."""
    programs = {
        "calls": own(tick="self.client.call(Trigger.Request())"),
        "spins": own(tick=SPUN),
        "rates": own(tick="self.rate.sleep()"),
        "loses": own(begin="threading.Thread(target=self.work).start()", work="1 / 0"),
        "works": own(tick=BUSY),
    }
    for name, text in programs.items():
        (tmp_path / f"{name}.py").write_text(text)
    client = await start({name: {"run": f"./{name}.py"} for name in programs})
    calls = await _ailing(client, "calls", STUCK)
    assert calls.source_line == "self.client.call(Trigger.Request())"
    assert "call_async(request)" in calls.meaning
    assert "add_done_callback" in calls.meaning
    assert "tick has been stuck since" in calls.exception
    assert "add_done_callback" in (await _ailing(client, "spins", STUCK)).meaning
    assert "create_timer" in (await _ailing(client, "rates", STUCK)).meaning
    loses = await _ailing(client, "loses", THREAD)
    assert (loses.source_line, loses.exception) == ("1 / 0", "ZeroDivisionError: division by zero")
    lines = await client.history("calls", 100)
    errors = [line.text for line in lines if line.severity is Severity.ERROR]
    assert own_words("\n".join(errors)) == calls.words
    for name in ("calls", "spins", "rates", "loses"):
        assert client.nodes[name].state in (NodeState.READY, NodeState.RUNNING)
        assert not well(client.nodes[name])

    async def went_on() -> bool:
        return any("went on" in line.text for line in await client.history("works", 100))

    assert await until(went_on, "the busy callback ends, and others follow", 60.0)
    assert well(client.nodes["works"])


async def test_who_waits_for_what_nobody_brings_is_not_healthy(start: Launch, tmp_path: Path) -> None:
    """For a service or action that nobody offers, or an answer that nobody takes in.

    Whoever waits for a service that comes, is idle, or has its answers called back is healthy.
    """
    # What is sent before it is known who offers it is lost.
    served = {"group": "MutuallyExclusiveCallbackGroup()", "begin": "self.client.wait_for_service()"}
    programs = {
        "goal": (own(begin=GOAL), "the action /count, which nobody offers"),
        "served": (own(begin="self.action.wait_for_server()"), "the action /count, which nobody"),
        "turns": (own(begin=TURNS), "the service /nobody, which nobody offers"),
        "early": (own(begin=TOO_EARLY), "an answer of the service /too_late"),
        "polls": (own(tick=POLLS), "add_done_callback"),
        "event": (own(tick=EVENT), "add_done_callback"),
        "sends": (own(tick="self.action.send_goal(Fibonacci.Goal())"), "the action /count"),
        "awaits": (own(define="async def", tick=f"{ASKS}; await future"), "callback group"),
        "pool_polls": (own(tick=POLLS, main=IN_TWO_THREADS), "callback group"),
        "pool_event": (own(tick=EVENT, main=IN_TWO_THREADS), "callback group"),
        "pool_out": (own(tick=SPUN, main=IN_TWO_THREADS, **served), "out of the executor"),
        "idle": (own(), ""),
        "patient": (own(begin=PATIENT), ""),
        "late": (own(main=LATE), ""),
        "async": (own(begin=SENDS), ""),
        "coroutine": (own(define="async def", tick=f"{ASKS}; await future", **served), ""),
        "pooled": (own(tick=EVENT, main=IN_TWO_THREADS, **served), ""),
        "nested": (own(tick=SPUN, **served), ""),
    }
    for name, (text, _meaning) in programs.items():
        (tmp_path / f"{name}.py").write_text(text)
    client = await start({name: {"run": f"./{name}.py"} for name in programs})
    for name, (_text, meaning) in programs.items():
        if meaning:
            await _ailing(client, name, STUCK, meaning)
            assert not well(client.nodes[name])
    fault = await _ailing(client, "goal", STUCK)
    assert "__init__ has been stuck since" in fault.exception
    assert fault.source_line == "rclpy.spin_until_future_complete(self, future)"
    fault = await _ailing(client, "pool_out", STUCK)
    assert fault.exception == "nothing of the node pool_out is called any more: no executor spins it"
    assert fault.source_line == "rclpy.spin_until_future_complete(self, future)"

    async def went_on() -> bool:
        return any("went on" in line.text for line in await client.history("patient", 100))

    assert await until(went_on, "the service comes", 60.0)
    for name, (_text, meaning) in programs.items():
        if not meaning:
            assert well(client.nodes[name]), name


async def test_who_never_spins_or_waits_in_a_circle_is_not_healthy(start: Launch, tmp_path: Path) -> None:
    """Nor is a deadlock of several threads; a loop that publishes, and a debugger, are neither."""
    programs = {
        "hangs": (own(begin="while True: time.sleep(0.1)"), "rclpy.spin(node)"),
        "waits": (own(main="node = Own()\nwhile True: time.sleep(0.1)"), "rclpy.spin(node)"),
        "asks": (own(begin="self.client.call(Trigger.Request())"), "spin_until_future_complete"),
        "grouped": (own(tick="self.client.call(Trigger.Request())", main=IN_TWO_THREADS), "callback group"),
        "pooled": (own(begin=IN_EVERY_THREAD, main=IN_TWO_THREADS), "Every thread"),
        "publishes": (own(main=PUBLISHES), ""),
        "turns": (own(main=SPINS_NOW_AND_THEN), ""),
        "debugged": (own(tick=DEBUGGED), ""),
        "stopped": (own(tick=STOPPED), ""),
    }
    for name, (text, _meaning) in programs.items():
        (tmp_path / f"{name}.py").write_text(text)
    client = await start({name: {"run": f"./{name}.py"} for name in programs})
    for name, (_text, meaning) in programs.items():
        if meaning:
            await _ailing(client, name, STUCK, meaning)
            assert not well(client.nodes[name])

    async def went_on() -> bool:
        return any("went on" in line.text for line in await client.history("stopped", 100))

    assert await until(went_on, "the stopped one goes on", 60.0)
    for name in ("publishes", "turns", "debugged", "stopped"):
        assert not client.nodes[name].ails, name
