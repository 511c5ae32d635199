"""A service: its form and time-out, its answers with their durations, and this session's calls."""

from __future__ import annotations

import asyncio
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

from textual import on
from textual.containers import Horizontal
from textual.widgets import Input, Static

from graph.data import ANSWER_WITHIN_S, CallResult
from graph.observer.requests import CallService
from text import ros2_words
from text.figures import figure
from text.i18n import N_, _, decimal, localized
from text.plain import plain
from text.sentences import reason_of
from tui.clock import time_of_day
from tui.graph.actions import cancel_request
from tui.graph.ask import AskPane, now_s
from tui.graph.links import heading, link, node_links
from tui.graph.pane import LONGEST
from tui.graph.parameter_words import typed
from tui.graph.places import GraphKind, GraphPlace
from tui.widgets.field import Field
from tui.widgets.rows import Cell, Column, Row

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from concurrent.futures import Future

    from textual.app import ComposeResult

    from graph.data import ServiceRow

USUAL_S = f"{ANSWER_WITHIN_S:g}"
LEAST_S, MOST_S = 0.1, 3600.0


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

    @property
    def field(self) -> Field:
        return self.query_one(Field)

    @property
    def seconds(self) -> float | None:
        """The seconds entered; None if that is not an allowed time-out."""
        try:
            typed_s = float(self.field.value.strip().replace(",", "."))
        except ValueError:
            return None
        return typed_s if math.isfinite(typed_s) and LEAST_S <= typed_s <= MOST_S else None

    def relabel(self) -> None:
        """Redraw in the current language."""
        self.query_one(".timeout-label", Static).update(_("Time-out"))
        self.query_one(".timeout-unit", Static).update(_("s"))
        limits = {"least": decimal(f"{LEAST_S:g}"), "greatest": f"{MOST_S:g}"}
        wrong = "" if self.seconds else "✗ " + _("{least} to {greatest} s").format(**limits)
        self.query_one(".timeout-bad", Static).update(wrong)

    def on_mount(self) -> None:
        self.relabel()

    @on(Input.Changed)
    def _changed(self, event: Input.Changed) -> None:
        event.stop()
        self.relabel()


MOST_CALLS = 50
"""Calls of one service that are kept."""


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
        """Whether its answer is still pending."""
        return self.result is None and not self.given_up


class ServicePane(AskPane):
    """Calls a service; the screen stays usable while it waits."""

    submit_title: ClassVar[str] = N_("Call")

    def __init__(self, *, id: str | None = None) -> None:
        super().__init__(id=id)
        self._calls: dict[str, list[ServiceCall]] = {}
        self._number = 0
        self._timeouts: dict[str, str] = {}
        """Maps a service to the text in its time-out field."""

    def compose_more(self) -> ComposeResult:
        """Below the form: how long to wait for an answer."""
        yield CallTimeout()

    @property
    def timeout(self) -> CallTimeout:
        return self.query_one(CallTimeout)

    def show_name(self, name: str) -> None:
        if name != self.name_shown:
            self._timeouts[self.name_shown] = self.timeout.field.value
            self.timeout.field.value = self._timeouts.get(name, USUAL_S)
        super().show_name(name)

    def relabel(self) -> None:
        """Redraw in the current language."""
        super().relabel()
        self.timeout.relabel()

    @property
    def calls(self) -> Sequence[ServiceCall]:
        """The calls of the service that is shown, the newest first."""
        return self._calls.get(self.name_shown, [])

    @property
    def chosen(self) -> ServiceCall | None:
        wanted = self.asked_rows.chosen
        return next((call for call in self.calls if str(call.number) == wanted), None)

    @property
    def row(self) -> ServiceRow | None:
        """The current row of the service in the graph."""
        update = self.graph_now
        services = () if update is None else update.services
        return next((row for row in services if row.name == self.name_shown), None)

    def type_names(self) -> tuple[str, ...]:
        return () if self.row is None else self.row.type_names

    def links(self) -> Sequence[Row]:
        """Return its type, its servers and its clients."""
        row, update = self.row, self.graph_now
        if row is None or update is None:
            return [heading(_("It has left the graph."))]
        callers = [node.name for node in update.nodes if row.name in node.clients]
        return [
            *(link(GraphPlace(GraphKind.TYPE, name), "type", _("type")) for name in row.type_names),
            *node_links(row.nodes, "serves", _("serves it")),
            *node_links(callers, "calls", _("calls it")),
        ]

    def asked(self) -> tuple[Sequence[Column], Sequence[Row]]:
        """Return the calls of this session."""
        return (
            (Column("", 8), Column("", 3), Column("")),
            [
                Row(str(call.number), (Cell(_at(call), "dim"), _sign(call), Cell(_summary(call))))
                for call in self.calls
            ],
        )

    def answer(self) -> tuple[str, str, Mapping[str, Any] | tuple[str, str]]:
        """Return the answer to the chosen call."""
        call = self.chosen
        if call is None:
            key = self.submit_key
            return (
                _("Response"),
                self.name_shown,
                (_("not called yet"), _("{key} calls it with what is filled in.").format(key=key)),
            )
        name = f"{self.name_shown} {call.number}"
        if call.result is None:
            return self._waiting(call, name)
        if call.result.ok and call.result.response is not None:
            return _answer_title(call, call.result), name, call.result.response
        words = plain(localized(call.result.error), LONGEST)
        if call.result.late is not None:
            title = _("No response within {n} s").format(n=decimal(f"{call.timeout_s:g}"))
            listens = _("A late response will be shown here; set a longer time-out below the form.")
            return title, name, (_("no response yet"), listens)
        told = _("{n} ms").format(n=decimal(f"{call.result.elapsed_s * 1000:.1f}"))
        return _("No response · {time}").format(time=told), name, (_("the call failed"), words)

    def _waiting(self, call: ServiceCall, name: str) -> tuple[str, str, tuple[str, str]]:
        if call.given_up:
            words = _("The node may still do what it was asked for; a late response will be shown here.")
            return _("No response"), name, (_("given up"), words)
        waited = int(now_s() - call.asked_s)
        title = _("Still waiting: {n} s of {most} s").format(n=waited, most=decimal(f"{call.timeout_s:g}"))
        key = self.deck.keys_of(cancel_request)[0]
        way_out = _("{key} stops waiting for it.").format(key=key)
        return title, name, (_("the call is under way"), way_out)

    def ros2_line(self, type_name: str, value: Mapping[str, Any]) -> str:
        return ros2_words.call(self.name_shown, type_name, value)

    def ros2_info(self) -> str:
        """Return what tells its type."""
        return ros2_words.service_type(self.name_shown)

    def ask(self, value: Mapping[str, Any]) -> None:
        graph, timeout_s = self.deck.feed.graph, self.timeout.seconds
        if timeout_s is None:
            self.warn(_("Not called: correct the time-out below the form."))
            self.timeout.field.focus()
            return
        if graph is None:
            return
        self._number += 1
        call = ServiceCall(self._number, value, now_s(), timeout_s)
        calls = self._calls.setdefault(self.name_shown, [])
        calls.insert(0, call)
        del calls[MOST_CALLS:]
        future = graph.ask(CallService(self.name_shown, self.type_names()[0], value, timeout_s))
        self.run_worker(self._take(call, self.name_shown, future), exit_on_error=False)
        self.redraw()
        self.asked_rows.choose(str(call.number))

    async def _take(self, call: ServiceCall, name: str, future: Future[CallResult]) -> None:
        result = await _outcome(call, name, future)
        if result.late is None:
            self._show(call, result)
            return
        if not call.given_up:
            self._show(call, result)
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
        """Stop waiting for the newest call."""
        call = next((call for call in self.calls if call.waits), None)
        if call is not None:
            call.given_up = True
            self.redraw()


async def _outcome(call: ServiceCall, name: str, future: Future[CallResult]) -> CallResult:
    try:
        return await asyncio.wrap_future(future)
    except Exception as error:  # noqa: BLE001 - any failure is reported
        return CallResult(name, False, None, reason_of(error), now_s() - call.asked_s)


def _answer_title(call: ServiceCall, result: CallResult) -> str:
    if call.late:
        words = _("Late response after {n} s (time-out {most} s)")
        return words.format(n=figure(result.elapsed_s, 1), most=decimal(f"{call.timeout_s:g}"))
    told = _("{n} ms").format(n=decimal(f"{result.elapsed_s * 1000:.1f}"))
    return _("Response in {time}").format(time=told)


def _at(call: ServiceCall) -> str:
    return time_of_day(call.asked_s)


def _sign(call: ServiceCall) -> Cell:
    if call.waits:
        return Cell("◔", "warn")
    if call.result is None:
        return Cell("○", "dim")
    return Cell("✓", "good") if call.result.ok else Cell("✗", "bad")


def _summary(call: ServiceCall) -> str:
    """Return the request and the answer in one line."""
    asked = _flat(call.request)
    result = call.result
    if result is None:
        return asked
    if not result.ok or result.response is None:
        return f"{asked} → {plain(localized(result.error), LONGEST)}"
    return f"{asked} → {_flat(result.response)}"


def _flat(tree: Mapping[str, Any]) -> str:
    parts = []
    for name, value in tree.items():
        nested = hasattr(value, "items")
        parts.append(f"{name} " + ("{…}" if nested else typed(value)[:40]))
    return plain(", ".join(parts), 120)
