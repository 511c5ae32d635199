"""How a log view looks, wide and narrow."""

from __future__ import annotations

import time
from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from launcher.status import LogLine, Severity
from tests.tui.logs.bare_log import HOSTILE, LogApp, line, shown

if TYPE_CHECKING:
    from textual.pilot import Pilot

    from tests.tui.snapshots import SnapCompare


def sample_lines() -> list[LogLine]:
    severities = list(Severity)
    names = ("sonar_front", "safety_stop", "ai_brain", "electronic_differential")
    made = [
        line(
            1 + number // 4,
            ("Публикую дистанцию: 1.84 м", "Путь свободен", HOSTILE[0], "Look around [bold]now[/]")[
                number % 4
            ],
            names[number % 4],
            severities[number % 5],
        )
        for number in range(24)
    ]
    return [*made, line(1250)]


def test_every_severity_and_a_gap(
    dump_compare: SnapCompare, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Severities as words and colours, a colour for each node, escapes as pictures, a gap told."""
    monkeypatch.setenv("TZ", "UTC")
    time.tzset()

    async def prepare(pilot: Pilot[None]) -> None:
        view = await shown(pilot, sample_lines())
        view.log_filter = replace(view.log_filter, search="дистан")
        await pilot.press("up", "up", *["shift+up"] * 4)

    assert dump_compare(LogApp(), terminal_size=(90, 20), run_before=prepare)


def test_a_narrow_log(dump_compare: SnapCompare, monkeypatch: pytest.MonkeyPatch) -> None:
    """Time, one letter and a short name are left; the text is folded between words."""
    monkeypatch.setenv("TZ", "UTC")
    time.tzset()

    async def prepare(pilot: Pilot[None]) -> None:
        await shown(pilot, sample_lines())

    assert dump_compare(LogApp(), terminal_size=(46, 16), run_before=prepare)
