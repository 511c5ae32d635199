"""`deck run` with real nodes: what it says, what it exits with, and that nothing is left."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import psutil
import pytest

from tests.deck_process import DeckProcess, alive, deck
from tests.unit.profile_files import written
from tests.waiting import wait_until


@pytest.fixture(autouse=True)
def _domain(ros_domain: int) -> int:
    return ros_domain


def test_a_lesson_runs_for_a_while_and_is_well(ros_domain: int) -> None:
    run = deck("run", "02-sonar-safety", "--for", "1.5", "--json")
    assert (run.process.returncode, run.errors) == (0, [])
    events = run.events()
    assert events[0]["event"] == "session"
    assert events[0]["domain"] == ros_domain
    summary = events[-1]
    assert summary["event"] == "summary"
    assert summary["healthy"] is True
    assert summary["exit_code"] == 0
    assert [(node["node"], node["state"]) for node in summary["nodes"]] == [
        ("sonar_front", "ready"),
        ("safety_stop", "ready"),
    ]
    heard = {event["node"] for event in events if event.get("logger")}
    assert heard == {"sonar_front", "safety_stop"}
    pids = {event["pid"] for event in events if event["event"] == "status" and event["pid"]}
    assert len(pids) == 2
    assert not any(map(alive, pids))


def test_nodes_that_fail_are_named_and_the_exit_code_says_so(tmp_path: Path) -> None:
    path = written(
        tmp_path,
        """\
        nodes:
          good: {exec: [sleep, 100]}
          bad: {exec: [sh, -c, "exit 3"]}
          late: {exec: [sleep, 100], ready: {topic: /never, within: 0.5}}
          stuck: {exec: [sleep, 100], needs: [late]}
          missing: {exec: [no-such-command], optional: true}
        """,
    )
    run = deck("run", str(path), "--for", "0.5", "--json")
    assert run.process.returncode == 1
    nodes = {node["node"]: node for node in run.events()[-1]["nodes"]}
    assert {name for name, node in nodes.items() if not node["healthy"]} == {*("bad", "late", "stuck")}
    assert nodes["bad"]["exit_code"] == 3
    assert nodes["missing"]["state"] == "exited"
    assert "not ready within 0.5 s" in nodes["late"]["detail"]


def test_a_supervisor_that_is_killed_is_the_reason_for_programs(tmp_path: Path) -> None:
    path = written(tmp_path, "nodes: {a: {exec: [sleep, 100]}}")
    run = DeckProcess("run", str(path), "--json")
    run.said('"state": "running"')
    os.kill(run.events()[0]["supervisor_pid"], signal.SIGKILL)
    assert run.finish() == 1
    summary = run.events()[-1]
    assert (summary["healthy"], summary["reason"]) == (False, "the supervisor is gone")


CHAIN = """\
nodes:
  base: {exec: [sleep, 100]}
  top: {exec: [sleep, 100], needs: [base]}
"""


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_stops_in_order_dependants_first(number: signal.Signals, tmp_path: Path) -> None:
    run = DeckProcess("run", str(written(tmp_path, CHAIN)), "--json")
    run.said('"node": "top", "state": "running"')
    run.signal(number)
    assert run.finish() == 0
    events = run.events()
    ends = [event["node"] for event in events if event["event"] == "status" and event["state"] == "exited"]
    assert ends == ["top", "base"]
    assert events[-1]["event"] == "summary"
    assert run.errors == []


STUBBORN = """\
nodes:
  stubborn: {exec: [sh, -c, "trap '' INT TERM; echo up; while :; do sleep 0.1; done"]}
"""


def test_the_second_ctrl_c_does_not_wait(tmp_path: Path) -> None:
    run = DeckProcess("run", str(written(tmp_path, STUBBORN)))
    run.said("[stubborn] up")
    run.signal(signal.SIGINT)
    run.said("Ctrl-C again does not wait")
    began = time.monotonic()
    run.signal(signal.SIGINT)
    run.finish()
    assert time.monotonic() - began < 9, "the two stages of five seconds were not skipped"
    assert run.errors == []


def test_a_reader_that_goes_stops_the_nodes_and_harms_nobody(tmp_path: Path) -> None:
    path = written(tmp_path, 'nodes: {talker: {exec: [sh, -c, "echo pid $$; sleep 1; while :; do echo x; done"]}}')
    reader, writer = os.pipe()
    process = subprocess.Popen(
        [sys.executable, "-m", "tui", "run", str(path)],
        stdin=subprocess.DEVNULL,
        stdout=writer,
        stderr=subprocess.PIPE,
        text=True,
    )
    os.close(writer)
    with os.fdopen(reader) as lines:
        node = next(int(line.split()[-1]) for line in lines if "] pid " in line)
    _out, errors = process.communicate()
    assert errors == ""
    assert process.returncode in (0, 1)
    wait_until(lambda: not alive(node), "the node has ended")


def test_ctrl_c_while_it_starts_leaves_nothing(tmp_path: Path) -> None:
    path = written(tmp_path, "nodes: {a: {exec: [sleep, 100]}}")
    run = DeckProcess("run", str(path))
    supervisor = wait_until(
        lambda: psutil.Process(run.process.pid).children(), "the supervisor starts", every_s=0.001
    )[0]
    run.signal(signal.SIGINT)
    assert run.finish() in (0, 130), run.errors
    assert run.errors == []
    wait_until(lambda: not alive(supervisor.pid), "the supervisor has ended")
    assert json.loads("\n".join(deck("ps", "--json").lines)) == []


PARAMETERS = """\
import json, rclpy, sys
from rclpy.node import Node

def main(args=None):
    rclpy.init(args=args)
    node = Node("unnamed", automatically_declare_parameters_from_overrides=True)
    values = {name: node.get_parameter(name).value for name in json.loads(NAMES)}
    print(node.get_name(), json.dumps({k: list(v) if hasattr(v, "tolist") else v
                                       for k, v in values.items()}, ensure_ascii=False), flush=True)
    node.destroy_node()
    rclpy.shutdown()

if __name__ == "__main__":
    main()
"""

VALUES = {
    "text": "1",
    "word": "no",
    "empty": "",
    "strange": "a: {b} # 'c' \"d\" \\ \t é😀",
    "whole": 9007199254740993,
    "real": 2.0,
    "tiny": 1e-7,
    "yes": True,
    "limits.near": 0.5,
    "texts": ["1", "b"],
    "mixed": [1.0, 2.5],
    "flags": [True, False],
}


@pytest.mark.parametrize("warm", [True, False])
def test_parameters_reach_the_node_with_their_types(warm: bool, tmp_path: Path) -> None:
    names = json.dumps(sorted(VALUES))
    (tmp_path / "tell_parameters.py").write_text(PARAMETERS.replace("NAMES", repr(names)), encoding="utf-8")
    params = dict(VALUES, mixed=[1, 2.5])
    node = {"run": "./tell_parameters.py", "params": params, "warm": warm, "ready": {"node": "x"}}
    written(tmp_path, json.dumps({"nodes": {"teller": node}}, ensure_ascii=False))
    run = deck("run", str(tmp_path / "lesson.yaml"))
    line = run.said("[teller] teller {")
    got = json.loads(line.partition("[teller] teller ")[2])
    assert got == VALUES
    assert {name: type(value) for name, value in got.items()} == {name: type(value) for name, value in VALUES.items()}


def gone(process: psutil.Process) -> bool:
    return not alive(process.pid)
