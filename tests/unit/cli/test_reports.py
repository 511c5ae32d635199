"""Output that never makes a run wait, reports for both readers, and whether a run went well."""

from __future__ import annotations

import io
import json
import os
import threading
from dataclasses import replace

import pytest

from cli.health import over, settled, well
from cli.line_writer import MOST_WAITING, LineWriter
from cli.report import JsonReport, Summary, TextReport
from launcher.status import IDLE, STUCK, THREAD, LogLine, NodeFault, NodeState, NodeStatus, SessionInfo, Severity
from text.output import Paint


def make_writer(fd: int, gone: threading.Event) -> LineWriter:
    return LineWriter(fd, "utf-8", left_out=lambda count: f"-{count}", on_gone=gone.set)


def test_a_reader_that_does_not_read_makes_nobody_wait_and_learns_what_it_missed() -> None:
    read, write = os.pipe()
    writer = make_writer(write, threading.Event())
    line = "x" * 100_000
    for _ in range(MOST_WAITING // len(line) + 20):
        writer.write(line)
    drained: list[str] = []

    def drain() -> None:
        with os.fdopen(read, encoding="utf-8") as lines:
            drained.extend(lines)

    reader = threading.Thread(target=drain)
    reader.start()
    writer.finish(30)
    writer.write("last")
    writer.finish(30)
    os.close(write)
    reader.join(30)
    assert drained[-1] == "last\n"
    assert drained[-2].startswith("-")
    assert int(drained[-2][1:]) + len(drained) - 2 == MOST_WAITING // len(line) + 20


SESSION = SessionInfo("run-1", "/p/09-brain.yaml", "09-brain", domain=42)


def line(text: str, severity: Severity = Severity.INFO, node: str = "sonar") -> LogLine:
    return LogLine(node, 7, 1.5, severity, text)


def text_report(names: list[str]) -> tuple[list[str], TextReport]:
    lines: list[str] = []
    return lines, TextReport(lines.append, names, Paint(io.StringIO()))


def test_log_lines_carry_node_and_severity_as_words() -> None:
    lines, report = text_report(["sonar", "ai_brain"])
    report.log(line("1.2 m"))
    report.log(line("close!", Severity.WARN, "ai_brain"))
    report.skipped("sonar", 3)
    report.note("stopping")
    assert lines == [
        "[sonar]    1.2 m",
        "[ai_brain] WARN close!",
        "[sonar]    3 lines left out, the log file has them",
        "[deck]     stopping",
    ]


STATUS = NodeStatus("sonar", "nodes.x", NodeState.FAILED, "exit code 3", restarts=2, exit_code=3)


def test_json_is_one_object_a_line_and_ends_with_the_summary() -> None:
    lines: list[str] = []
    report = JsonReport(lines.append)
    report.session(SESSION)
    report.status(STATUS)
    report.log(line("Дистанция\u2028", Severity.WARN))
    report.skipped("sonar", 5)
    report.note("nothing for programs")
    report.summary(Summary([STATUS], {"sonar": False}, 4.25, ""))
    events = [json.loads(each) for each in lines]
    assert [event["event"] for event in events] == [*("session", "status", "log", "skipped", "summary")]
    assert events[0]["domain"] == 42
    assert events[2]["text"] == "Дистанция\u2028"
    assert events[2]["severity"] == "warn"
    assert events[-1]["exit_code"] == 1
    assert events[-1]["nodes"][0]["healthy"] is False


def node(name: str, state: NodeState, **more: object) -> NodeStatus:
    return replace(NodeStatus(name, "x", state), **more)  # type: ignore[arg-type]


READY, RUNNING, FAILED = NodeState.READY, NodeState.RUNNING, NodeState.FAILED
STARTING, WAITING, EXITED = NodeState.STARTING, NodeState.WAITING, NodeState.EXITED
LATE = "not ready within 10 s: nobody publishes /scan"


@pytest.mark.parametrize("kind", ["syntax", "import", "crash", STUCK, THREAD, IDLE])
@pytest.mark.parametrize("state", [READY, RUNNING, EXITED, STARTING])
def test_a_node_that_ails_is_not_healthy_whatever_its_state(kind: str, state: NodeState) -> None:
    ailing = node("a", state, fault=NodeFault(kind, "/own/a.py", 3, exception="x"))
    assert not well(ailing)
    assert not well(ailing, on_the_way=True)
    assert well(ailing, optional=("a",))
    assert ailing.why == "a.py:3: x"


def statuses(*nodes: NodeStatus) -> dict[str, NodeStatus]:
    return {each.name: each for each in nodes}


@pytest.mark.parametrize(
    ("nodes", "is_settled", "is_over"),
    [
        ([node("a", READY), node("b", RUNNING)], True, False),
        ([node("a", READY), node("b", STARTING)], False, False),
        ([node("a", READY), node("b", WAITING, needs=("a",))], False, False),
        ([node("a", STARTING), node("b", WAITING, needs=("a",))], False, False),
        ([node("a", FAILED), node("b", WAITING, needs=("a",))], True, True),
        ([node("a", RUNNING, detail=LATE), node("b", WAITING, needs=("a",))], True, False),
        ([node("a", WAITING)], False, False),
        ([node("a", EXITED), node("b", FAILED)], True, True),
        ([node("a", EXITED), node("b", NodeState.BACKOFF)], True, False),
        ([node("a", EXITED), node("b", NodeState.STOPPING)], True, False),
    ],
)
def test_when_all_is_up_and_when_all_is_over(nodes: list[NodeStatus], is_settled: bool, is_over: bool) -> None:
    assert settled(statuses(*nodes)) is is_settled
    assert over(statuses(*nodes)) is is_over


@pytest.mark.parametrize(
    ("status", "is_well"),
    [
        (node("a", READY), True),
        (node("a", RUNNING), True),
        (node("a", RUNNING, detail="whether it is ready cannot be determined"), True),
        (node("a", RUNNING, detail=LATE), False),
        (node("a", READY, restarts=1), False),
        (node("a", EXITED, exit_code=0), True),
        (node("a", EXITED, exit_code=3), False),
        (node("a", EXITED, signal="SIGKILL"), False),
        (node("a", FAILED), False),
        (node("a", NodeState.BACKOFF), False),
        (node("a", STARTING), False),
        (node("a", WAITING), False),
    ],
)
def test_which_nodes_are_well(status: NodeStatus, is_well: bool) -> None:
    assert well(status) is is_well
    assert well(status, {"a"})
