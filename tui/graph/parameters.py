"""The parameters of a node: read on request, each with its type and its allowed values."""

from __future__ import annotations

import asyncio
import re
from collections.abc import Iterable
from concurrent.futures import Future
from typing import Any, ClassVar

from textual import getters
from textual.app import ComposeResult
from textual.containers import Vertical
from textual.widgets import Static

from graph.data import ParameterRow, ParametersResult, Sample, Value
from graph.observer.requests import ReadParameters
from text.i18n import N_, _, localized, ngettext
from text.plain import is_plain, plain
from text.yaml_scalars import in_quotes, unquoted
from tui import clock
from tui.frame.host import host_of
from tui.graph.pane import LONGEST, EmptyNotice
from tui.widgets.rows import Cell, Column, Row, Rows
from tui.widgets.working import Working

ROOMY = 70
"""Cells from which on there are columns for type and limits."""
TICK_S = 0.5
PARAMETER_EVENTS = "/parameter_events"
"""The topic on which every node reports changes of its parameters, whoever made them."""
UNITS = (
    N_("m"), N_("s"), N_("ms"), N_("Hz"), N_("V"), N_("rad"), N_("deg"), N_("m/s"), N_("rad/s"),
    N_("deg/s"),
)  # fmt: skip
MEASURE = re.compile(r"(?P<least>\S+) \.\. (?P<greatest>\S+)(?: (?P<unit>\S+))?")
"""The notation of Deck's own nodes for a range in their constraints."""


def typed(value: Value | None) -> str:
    """Return a value as one would type it: a text unchanged, a list with commas in brackets.

    A text with invisible parts is in double quotes, with escapes; `meant` reverses that.
    """
    if value is None:
        return ""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return value if is_plain(value) and unquoted(value) is None else in_quotes(value)
    if isinstance(value, (int, float)):
        return repr(value)
    items: Any = value.tolist() if hasattr(value, "tolist") else value
    # Quotes keep a text in a list from being taken for a number.
    return "[" + ", ".join(in_quotes(item) if isinstance(item, str) else typed(item) for item in items) + "]"


def meant(text: str) -> str:
    """Return the text that was meant: what is between double quotes, otherwise all of it."""
    between = unquoted(text)
    return text if between is None else between


def allowed_words(row: ParameterRow) -> str:
    parts, constraints = [], row.constraints
    if row.read_only:
        parts.append(_("read-only"))
    if row.least is not None and row.greatest is not None:
        words = f"{row.least:g}…{row.greatest:g}"
        told = MEASURE.fullmatch(constraints)
        if told and _same(told["least"], row.least) and _same(told["greatest"], row.greatest):
            # The constraints only repeat the range, with all its digits and its unit.
            unit, constraints = told["unit"] or "", ""
            words = plain(f"{told['least']}…{told['greatest']}", LONGEST)
            words = f"{words} {_(unit) if unit in UNITS else plain(unit, LONGEST)}".rstrip()
        parts.append(words)
    if row.step:
        parts.append(_("step {n}").format(n=f"{row.step:g}"))
    if constraints:
        parts.append(plain(_(constraints), LONGEST))
    return ", ".join(parts)


def _same(told: str, number: float) -> bool:
    try:
        return f"{float(told):g}" == f"{number:g}"
    except ValueError:
        return False


class GraphParameters(Vertical, Working):
    """A table of parameters, or the reason why there is none."""

    DEFAULT_CSS: ClassVar[str] = """
    GraphParameters {
        .parameters-title { height: 1; width: 1fr; background: $panel; color: $text-muted;
            padding: 0 1; }
        Rows { height: 1fr; }
    }
    """

    def __init__(self) -> None:
        super().__init__()
        self.node = ""
        self._result: ParametersResult | None = None
        self._asked_s: float | None = None
        self._question = 0
        self._changed = False
        """Whether a parameter may have changed since the node was asked."""
        self._processes: tuple[int, ...] | None = None
        """Processes of the node that was asked; None until they are known."""

    def compose(self) -> ComposeResult:
        yield Static(classes="parameters-title", markup=False)
        yield EmptyNotice()
        yield Rows(id="graph-parameters")

    def on_mount(self) -> None:
        self.set_interval(TICK_S, self._label)

    table = getters.query_one(Rows)

    @property
    def rows(self) -> tuple[ParameterRow, ...]:
        return () if self._result is None else self._result.parameters

    @property
    def chosen(self) -> ParameterRow | None:
        return next((row for row in self.rows if row.name == self.table.chosen), None)

    def forget(self) -> None:
        self._question += 1
        self.node, self._result, self._asked_s, self._processes = "", None, None, None
        self.redraw()

    def read(self, node: str) -> None:
        """Ask the node for its parameters; the previous ones stay until it answers."""
        graph = host_of(self).feed.graph
        if node != self.node:
            self.forget()
        self.node = node
        if graph is not None and node:
            self._question += 1
            self._changed = False
            self._asked_s = clock.now()
            self.run_worker(self._take(graph.ask(ReadParameters(node)), self._question), exit_on_error=False)
        self.redraw()

    def hear(self, events: Iterable[Sample]) -> None:
        """Read them again if these messages of /parameter_events are about this node."""
        if any(event.value.get("node") == self.node for event in events):
            self._read_anew()

    def see(self, processes: tuple[int, ...]) -> None:
        """Read them again if the node has a new process: a restarted node has its initial values.

        Empty if it is not in the graph, or if the middleware does not know the process.
        """
        if self._processes is None:
            self._processes = processes
        elif processes and processes != self._processes:
            self._processes = processes
            self._read_anew()

    def _read_anew(self) -> None:
        if self._asked_s is None:
            self.read(self.node)
        else:
            # The pending answer may be outdated, but asking again every time might never finish.
            self._changed = True

    async def _take(self, future: Future[ParametersResult], question: int) -> None:
        result: Any = await asyncio.wrap_future(future)
        if question == self._question:
            self._result, self._asked_s = result, None
            if self._changed:
                self.read(self.node)
            self.redraw()

    def on_resize(self) -> None:
        self.redraw()

    def on_language_changed(self) -> None:
        self.redraw()

    def redraw(self) -> None:
        if not self.is_mounted:
            return
        self._label()
        words, table = self.query_one(EmptyNotice), self.table
        words.show(*self._why_empty())
        words.display = bool(words.said[0])
        table.display = not words.display
        width = self.size.width
        name = max((len(row.name) for row in self.rows), default=0)
        columns = [Column(_("Parameter"), min(name, max(8, int(width * 0.45))) or 8), Column(_("Value"))]
        if width >= ROOMY:
            columns += [Column(_("Type"), 13), Column(_("Allowed"), 20)]
        table.show(columns, [Row(row.name, _cells(row)[: len(columns)]) for row in self.rows])

    def _label(self) -> None:
        title = self.query_one(".parameters-title", Static)
        words = _("Parameters")
        if self._asked_s is not None:
            waited = int(clock.now() - self._asked_s)
            words += " · " + _("asked, no answer for {n} s").format(n=waited)
        elif self._result is not None and not self._result.error:
            count = len(self.rows)
            words = ngettext("{n} parameter", "{n} parameters", count).format(n=count)
            words += " · " + _("read in {n} ms").format(n=round(self._result.elapsed_s * 1000))
        if title.content != words:
            title.update(words)

    def _why_empty(self) -> tuple[str, str]:
        if self._result is None:
            if host_of(self).feed.graph is None:
                return _("no lesson is running"), ""
            return _("the node is being asked"), _("A node that hangs answers nothing.")
        if self._result.error:
            return _("its parameters could not be read"), plain(localized(self._result.error), LONGEST)
        return ("", "") if self.rows else (_("this node has no parameters"), "")


def _cells(row: ParameterRow) -> tuple[Cell, ...]:
    value = _("not set") if row.value is None else plain(typed(row.value), LONGEST)
    said = Cell(plain(row.name, LONGEST)), Cell(f"⊘ {value}" if row.read_only else value)
    return (*said, Cell(row.type_name, "dim"), Cell(allowed_words(row), "dim"))
