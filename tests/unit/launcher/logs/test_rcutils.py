"""What a log line says of itself: severity, time, logger."""

from __future__ import annotations

import pytest

from launcher.logs.rcutils import AT_ONCE_S, SeverityParser
from launcher.status import Severity

NOW = 1_700_000_500.0


def severities(*lines: str) -> list[Severity]:
    parser = SeverityParser()
    return [parser.parse(line, NOW).severity for line in lines]


def test_the_format_of_rcutils() -> None:
    line = "[WARN] [1700000000.123456789] [robot.sonar]: [red] too close: 0.3 m"
    parsed = SeverityParser().parse(line, NOW)
    assert parsed.severity is Severity.WARN
    assert parsed.time_s == pytest.approx(1_700_000_000.123456789)
    assert parsed.logger == "robot.sonar"
    assert parsed.text == "[red] too close: 0.3 m"


@pytest.mark.parametrize("name", ["DEBUG", "INFO", "WARN", "ERROR", "FATAL"])
def test_every_severity_of_rcutils(name: str) -> None:
    (severity,) = severities(f"[{name}] [1700000000.0] [x]: y")
    assert severity.name == name


def test_an_empty_message_is_one() -> None:
    parsed = SeverityParser().parse("[INFO] [1700000000.5] [x]: ", NOW)
    assert (parsed.text, parsed.logger) == ("", "x")


@pytest.mark.parametrize("stamp", ["0.5", "120.000000000", "999999999999.9"])
def test_a_stamp_that_is_no_wall_clock_gives_way_to_the_time_of_reading(stamp: str) -> None:
    assert SeverityParser().parse(f"[INFO] [{stamp}] [x]: y", NOW).time_s == NOW


def test_a_plain_line_is_information_as_of_its_reading() -> None:
    parsed = SeverityParser().parse("hello", NOW)
    assert (parsed.severity, parsed.time_s, parsed.logger) == (Severity.INFO, NOW, "")


def test_the_further_lines_of_a_message_have_its_severity_and_logger() -> None:
    parser = SeverityParser()
    parser.parse("[ERROR] [1700000000.0] [arm]: joints:", NOW)
    second = parser.parse("  elbow 12", NOW + AT_ONCE_S / 2)
    assert (second.severity, second.logger) == (Severity.ERROR, "arm")


def test_what_comes_later_is_no_part_of_the_message() -> None:
    parser = SeverityParser()
    parser.parse("[ERROR] [1700000000.0] [arm]: joints:", NOW)
    assert parser.parse("ready", NOW + 10 * AT_ONCE_S).severity is Severity.INFO


def test_a_traceback_is_an_error_to_its_last_line_and_not_beyond() -> None:
    lines = (
        "Traceback (most recent call last):",
        '  File "x.py", line 1, in <module>',
        "    1 / 0",
        "ZeroDivisionError: division by zero",
        "",
        "During handling of the above exception, another exception occurred:",
        "",
        "Traceback (most recent call last):",
        '  File "x.py", line 3, in <module>',
        "KeyError: 'x'",
    )
    assert severities(*lines) == [Severity.ERROR] * len(lines)
    after = severities(*lines, "[INFO] [1700000000.0] [x]: on we go")
    assert after[-1] is Severity.INFO


@pytest.mark.parametrize(
    ("line", "severity"),
    [
        ("WARNING: low battery", Severity.WARN),
        ("ERROR:root:no camera", Severity.ERROR),
        ("[ERROR] no port", Severity.ERROR),
        ("CRITICAL: fire", Severity.FATAL),
        ("2026-01-01 10:00:00.123 [RTPS_TRANSPORT_SHM Error] no port", Severity.ERROR),
        ("ERRORS are good teachers", Severity.INFO),
        ("INFORMATION", Severity.INFO),
    ],
)
def test_the_usual_words_of_other_programs(line: str, severity: Severity) -> None:
    assert severities(line) == [severity]


def test_that_the_middleware_takes_another_port_is_no_error() -> None:
    line = (
        "2026-01-01 10:00:00.123 [RTPS_TRANSPORT_SHM Error] Failed init_port fastrtps_port7016: "
        "open_and_lock_file failed -> Function open_port_internal"
    )
    parsed = SeverityParser().parse(line, NOW, Severity.ERROR)
    assert (parsed.severity, parsed.text) == (Severity.DEBUG, line)


def test_a_colour_counts_where_there_is_no_word() -> None:
    parsed = SeverityParser().parse("no port", NOW, Severity.ERROR)
    assert parsed.severity is Severity.ERROR
    stamped = SeverityParser().parse("[INFO] [1700000000.0] [x]: y", NOW, Severity.ERROR)
    assert stamped.severity is Severity.INFO
