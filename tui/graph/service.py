"""A service: its form and time-out, its answers with their durations, and this session's calls."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Mapping, Sequence
from concurrent.futures import Future
from dataclasses import dataclass
from typing import Any

from textual import getters, on
from textual.app import ComposeResult
from textual.containers import Horizontal
from textual.widgets import Input, Static

from graph.data import ANSWER_WITHIN_S, CallResult
from graph.observer.requests import CallService
from text import ros2_words
from text.figures import figure
from text.i18n import N_, _, decimal, localized
from text.plain import plain
from text.sentences import reason_of
from tui import clock
from tui.graph.actions import cancel_request
from tui.graph.ask import Answer, AskPane
from tui.graph.pane import LONGEST
from tui.graph.parameters import typed
from tui.widgets.field import Field
from tui.widgets.rows import Cell, Column, Row
from tui.yaml_form.form import submit_form

USUAL_S = f"{ANSWER_WITHIN_S:g}"
LEAST_S, MOST_S = 0.1, 3600.0
MOST_CALLS = 50
TICK_S = 0.5
"""How often the waiting time is updated."""


class CallTimeout(Horizontal):
    """A field for seconds, with the allowed range beside it if the value is invalid."""

    DEFAULT_CSS = """
    CallTimeout {
        height: 1; width: 1fr; background: $panel; padding: 0 1;
        Static { width: auto; color: $text-muted; }
        Field { width: 8; margin: 0 1; }
        .timeout-bad { color: $text-error; text-style: bold; padding: 0 1; }
    }
    """

    def compose(self) -> ComposeResult:
        yield Static(classes="timeout-label", markup=False)
        yield Field(USUAL_S, compact=True, select_on_focus=False, id="call-timeout")
        yield Static(classes="timeout-unit", markup=False)
        yield Static(classes="timeout-bad", markup=False)

    field = getters.query_one(Field)

    @property
    def seconds(self) -> float | None:
        """The seconds entered; None if that is not an allowed time-out."""
        try:
            typed_s = float(self.field.value.strip().replace(",", "."))
        except ValueError:
            return None
        return typed_s if math.isfinite(typed_s) and LEAST_S <= typed_s <= MOST_S else None

    def on_language_changed(self) -> None:
        self.query_one(".timeout-label", Static).update(_("Time-out"))
        self.query_one(".timeout-unit", Static).update(_("s"))
        limits = {"least": decimal(f"{LEAST_S:g}"), "greatest": f"{MOST_S:g}"}
        wrong = "" if self.seconds else "✗ " + _("{least} to {greatest} s").format(**limits)
        self.query_one(".timeout-bad", Static).update(wrong)

    def on_mount(self) -> None:
        self.on_language_changed()

    @on(Input.Changed)
    def _changed(self, event: Input.Changed) -> None:
        event.stop()
        self.on_language_changed()


@dataclass
class ServiceCall:
    """One call of this session."""

    number: int
    request: Mapping[str, Any]
    asked_s: float
    timeout_s: float
    result: CallResult | None = None
    given_up: bool = False
    late: bool = False
    """Whether its answer came after the time-out was shown."""

    @property
    def waits(self) -> bool:
        return self.result is None and not self.given_up

    @property
    def sign(self) -> Cell:
        if self.result is None:
            return Cell("◔", "warn") if self.waits else Cell("○", "dim")
        return Cell("✓", "good") if self.result.ok else Cell("✗", "bad")

    @property
    def summary(self) -> str:
        asked, result = _flat(self.request), self.result
        if result is None:
            return asked
        if not result.ok or result.response is None:
            return f"{asked} → {plain(localized(result.error), LONGEST)}"
        return f"{asked} → {_flat(result.response)}"


def _flat(tree: Mapping[str, Any]) -> str:
    parts = (f"{name} " + ("{…}" if hasattr(value, "items") else typed(value)[:40]) for name, value in tree.items())
    return plain(", ".join(parts), 120)


class ServicePane(AskPane):
    """Calls a service; the screen stays usable while it waits."""

    submit_title = N_("Call")
    calls_it = N_("calls it")

    def __init__(self, *, id: str) -> None:
        super().__init__(id=id)
        self._calls: dict[str, list[ServiceCall]] = {}
        self._number = 0
        self._timeouts: dict[str, str] = {}
        """Maps a service to the text in its time-out field."""

    def compose_more(self) -> ComposeResult:
        yield CallTimeout()

    def on_mount(self) -> None:
        self.set_interval(TICK_S, self._tick)

    def _tick(self) -> None:
        if self.can_cancel:
            self.redraw()

    timeout = getters.query_one(CallTimeout)

    @property
    def calls(self) -> list[ServiceCall]:
        return self._calls.setdefault(self.name_shown, [])

    def show_name(self, name: str) -> None:
        if name != self.name_shown:
            self._timeouts[self.name_shown] = self.timeout.field.value
            self.timeout.field.value = self._timeouts.get(name, USUAL_S)
        super().show_name(name)

    def ends(self) -> tuple[Sequence[str], Sequence[str], Sequence[str]] | None:
        update = self.graph_now
        for row in () if update is None else update.services:
            if row.name == self.name_shown and update is not None:
                callers = [node.name for node in update.nodes if row.name in node.clients]
                return row.type_names, row.nodes, callers
        return None

    def asked(self) -> tuple[Sequence[Column], Sequence[Row]]:
        return (Column("", 8), Column("", 3), Column("")), [
            Row(str(call.number), (Cell(clock.time_of_day(call.asked_s), "dim"), call.sign, Cell(call.summary)))
            for call in self.calls
        ]

    def answer(self) -> Answer:
        call = next((call for call in self.calls if str(call.number) == self.asked_rows.chosen), None)
        if call is None:
            way_out = _("{key} calls it with what is filled in.").format(key=self.deck.keys_of(submit_form)[0])
            return _("Response"), self.name_shown, (_("not called yet"), way_out)
        name, result, most = f"{self.name_shown} {call.number}", call.result, decimal(f"{call.timeout_s:g}")
        if result is None and call.given_up:
            words = _("The node may still do what it was asked for; a late response will be shown here.")
            return _("No response"), name, (_("given up"), words)
        if result is None:
            waited = int(clock.now() - call.asked_s)
            title = _("Still waiting: {n} s of {most} s").format(n=waited, most=most)
            way_out = _("{key} stops waiting for it.").format(key=self.deck.keys_of(cancel_request)[0])
            return title, name, (_("the call is under way"), way_out)
        took = _("{n} ms").format(n=decimal(f"{result.elapsed_s * 1000:.1f}"))
        if result.ok and result.response is not None:
            title = _("Response in {time}").format(time=took)
            if call.late:
                words = _("Late response after {n} s (time-out {most} s)")
                title = words.format(n=figure(result.elapsed_s, 1), most=most)
            return title, name, result.response
        if result.late is not None:
            listens = _("A late response will be shown here; set a longer time-out below the form.")
            return _("No response within {n} s").format(n=most), name, (_("no response yet"), listens)
        words = plain(localized(result.error), LONGEST)
        return _("No response · {time}").format(time=took), name, (_("the call failed"), words)

    def ros2_line(self, type_name: str, value: Mapping[str, Any]) -> str:
        return ros2_words.call(self.name_shown, type_name, value)

    def ros2_info(self) -> str:
        return ros2_words.service_type(self.name_shown)

    def ask(self, type_name: str, value: Mapping[str, Any]) -> None:
        graph, timeout_s = self.deck.feed.graph, self.timeout.seconds
        if timeout_s is None:
            self.warn(_("Not called: correct the time-out below the form."))
            self.timeout.field.focus()
            return
        if graph is None:
            return
        self._number += 1
        call = ServiceCall(self._number, value, clock.now(), timeout_s)
        self.calls.insert(0, call)
        del self.calls[MOST_CALLS:]
        future = graph.ask(CallService(self.name_shown, type_name, value, timeout_s))
        self.run_worker(self._take(call, self.name_shown, future), exit_on_error=False)
        self.redraw()
        self.asked_rows.choose(str(call.number))

    async def _take(self, call: ServiceCall, name: str, future: Future[CallResult]) -> None:
        result = await _outcome(call, name, future)
        if result.late is None or not call.given_up:
            self._show(call, result)
        if result.late is None:
            return
        result = await _outcome(call, name, result.late)
        call.late = result.ok
        self._show(call, result)
        if call.late:
            words = _("{name}: the response arrived after {n} s.")
            told = words.format(name=name, n=figure(result.elapsed_s, 1))
            self.notify(plain(told, LONGEST), markup=False)

    def _show(self, call: ServiceCall, result: CallResult) -> None:
        call.result = result
        if self.is_mounted:
            self.redraw()
            self.screen.refresh_bindings()

    @property
    def can_cancel(self) -> bool:
        return any(call.waits for call in self.calls)

    def cancel(self) -> None:
        call = next((call for call in self.calls if call.waits), None)
        if call is not None:
            call.given_up = True
            self.redraw()


async def _outcome(call: ServiceCall, name: str, future: Future[CallResult]) -> CallResult:
    try:
        return await asyncio.wrap_future(future)
    except Exception as error:  # noqa: BLE001 - any failure is reported
        return CallResult(name, False, None, reason_of(error), clock.now() - call.asked_s)
