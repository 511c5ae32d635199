"""A bare app with nothing but the log, and lines for it."""

from __future__ import annotations

from collections.abc import Sequence

from textual.app import App, ComposeResult
from textual.pilot import Pilot

from launcher.status import LogLine, Severity
from tui.log_view.pane import LogPane
from tui.log_view.view import LogView


class LogApp(App[None]):
    """A bare app with nothing but the log."""

    def __init__(self, period_s: float = 0.0) -> None:
        super().__init__()
        self.pane = LogPane(LogView(period_s=period_s, file_of=lambda node: f"/logs/{node}.log"))

    def compose(self) -> ComposeResult:
        yield self.pane

    def on_mount(self) -> None:
        self.pane.view.focus()


def line(seq: int, text: str = "", node: str = "sonar_front", severity: Severity = Severity.INFO) -> LogLine:
    return LogLine(node, seq, 1_767_225_600.0 + seq, severity, text or f"line {seq}")


def lines(first: int, count: int) -> list[LogLine]:
    return [line(seq) for seq in range(first, first + count)]


def rows(view: LogView) -> list[str]:
    return [view.render_line(y).text.rstrip() for y in range(view.size.height)]


def texts(view: LogView) -> list[str]:
    return [row.split("sonar_front ", 1)[-1] for row in rows(view) if row]


async def shown(pilot: Pilot[None], lines: Sequence[LogLine]) -> LogView:
    app = pilot.app
    assert isinstance(app, LogApp)
    app.pane.view.append(lines)
    await pilot.pause()
    return app.pane.view
