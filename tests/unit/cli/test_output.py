"""Output that never makes a run wait, colours only where wanted, and reports for both readers."""

from __future__ import annotations

import io
import json
import os
import threading

import pytest

from cli.line_writer import MOST_WAITING, LineWriter
from cli.report import JsonReport, Summary, TextReport
from launcher.status import LogLine, NodeState, NodeStatus, SessionInfo, Severity
from tests.waiting import wait_until
from text.i18n import set_language
from text.output import Paint, harmless, json_text, table
from text.plain import is_plain
from text.sentences import say


class Terminal(io.StringIO):
    """A stream that says it is a terminal."""

    def isatty(self) -> bool:
        return True


@pytest.mark.parametrize(
    ("stream", "environ", "coloured"),
    [
        (Terminal(), {"TERM": "xterm"}, True),
        (Terminal(), {"TERM": "xterm", "NO_COLOR": "1"}, False),
        (Terminal(), {"TERM": "dumb"}, False),
        (io.StringIO(), {"TERM": "xterm"}, False),
    ],
)
def test_colours_only_where_they_are_wanted(
    stream: io.StringIO, environ: dict[str, str], coloured: bool
) -> None:
    assert (Paint(stream, environ)("x", "31") != "x") is coloured


def test_a_table_is_as_wide_as_it_must_be() -> None:
    assert table(("A", "LONG"), [("аб", "1"), ("c", "")]) == ["A   LONG", "аб  1", "c"]


def make_writer(fd: int, gone: threading.Event) -> LineWriter:
    """Return a writer that tells how many lines it left out as `-N`."""
    return LineWriter(fd, "utf-8", left_out=lambda count: f"-{count}", on_gone=gone.set)


def test_lines_come_out_in_order() -> None:
    read, write = os.pipe()
    writer = make_writer(write, threading.Event())
    for number in range(1000):
        writer.write(f"строка {number}")
    writer.finish()
    os.close(write)
    with os.fdopen(read, encoding="utf-8") as lines:
        assert lines.read().split("\n")[:-1] == [f"строка {number}" for number in range(1000)]


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


def test_a_reader_that_goes_is_noticed_once_and_harms_nobody() -> None:
    read, write = os.pipe()
    gone = threading.Event()
    writer = make_writer(write, gone)
    os.close(read)
    writer.write("x")
    assert gone.wait(30)
    wait_until(lambda: writer.gone, "the writer knows")
    writer.write("y")
    writer.finish()
    os.close(write)


SESSION = SessionInfo("run-1", "/p/09-brain.yaml", "09-brain", domain=42)


def line(text: str, severity: Severity = Severity.INFO, node: str = "sonar") -> LogLine:
    """Return a log line."""
    return LogLine(node, 7, 1.5, severity, text)


def text_report(names: list[str]) -> tuple[list[str], TextReport]:
    """Return a report without colours and the lines that it writes."""
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


def test_the_supervisors_words_are_translated() -> None:
    lines, report = text_report(["sonar"])
    set_language("ru")
    try:
        report.log(line(say("started, pid {pid}", pid=12)))
    finally:
        set_language("en")
    assert lines == ["[sonar] запущен, pid 12"]


def test_markup_and_braces_of_a_node_are_left_alone() -> None:
    lines, report = text_report(["sonar"])
    report.log(line("{x} %s [red]"))
    assert lines == ["[sonar] {x} %s [red]"]


STATUS = NodeStatus("sonar", "nodes.x", NodeState.FAILED, "exit code 3", restarts=2, exit_code=3)


def test_the_summary_names_who_is_not_well() -> None:
    lines, report = text_report(["sonar"])
    report.summary(Summary([STATUS], {"sonar": False}, 4.25, ""))
    assert lines == [
        "",
        "NODE   RESULT  STATE   RESTARTS  DETAIL",
        "sonar  FAILED  failed  2         exit code 3",
        "not healthy: sonar; 4.2 s",
    ]


def test_the_summary_ends_with_what_ended_the_run() -> None:
    lines, report = text_report(["sonar"])
    gone = say("the supervisor is gone")
    report.summary(Summary([STATUS], {"sonar": True}, 4.25, gone))
    assert lines[-1] == "ended from elsewhere: the supervisor is gone; 4.2 s"
    report.summary(Summary([STATUS], {"sonar": False}, 4.25, gone))
    assert lines[-1] == "not healthy: sonar; ended from elsewhere: the supervisor is gone; 4.2 s"


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
    assert [event["event"] for event in events] == [
        *("session", "status", "log", "skipped", "summary")
    ]
    assert events[0]["domain"] == 42
    assert events[2]["text"] == "Дистанция\u2028"
    assert events[2]["severity"] == "warn"
    assert events[-1]["exit_code"] == 1
    assert events[-1]["nodes"][0]["healthy"] is False


def test_of_what_a_terminal_obeys_only_our_own_colours_are_written() -> None:
    line = Paint(Terminal(), {"TERM": "xterm"})("a\x1b[31mb", "31", "1")
    assert harmless(f"{line}\x1b[45m\x1b]0;x\x07\nnext") == (
        "\x1b[31;1ma␛[31mb\x1b[0m␛[45m␛]0;x␇\nnext"
    )


def test_json_is_read_back_as_it_was_and_shows_no_more_than_it_should() -> None:
    value = {"a\x1b": ["Привет \u202e \U000e0065 \ud800 \x9b\n", 1.5, None]}
    text = json_text(value)
    assert json.loads(text) == value
    assert "Привет" in text
    assert is_plain(text)
    assert json.loads(json_text(value, indent=2)) == value
