"""How long an answer is waited for, chosen below the form of a service."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from textual import on
from textual.containers import Horizontal
from textual.widgets import Input, Static

from text.i18n import _, decimal
from tui.widgets.field import Field

if TYPE_CHECKING:
    from textual.app import ComposeResult

USUAL_S = "5"
LEAST_S, MOST_S = 0.1, 3600.0


class CallTimeout(Horizontal):
    """A field for seconds, and beside it what they may be if they are none."""

    DEFAULT_CSS = """
    CallTimeout {
        height: 1; width: 1fr; background: $panel; padding: 0 1;
        Static { width: auto; color: $text-muted; }
        Field { width: 8; margin: 0 1; }
        .timeout-bad { color: $text-error; text-style: bold; padding: 0 1; }
    }
    """

    def compose(self) -> ComposeResult:
        """All in one line."""
        yield Static(classes="timeout-label", markup=False)
        yield Field(USUAL_S, compact=True, select_on_focus=False, id="call-timeout")
        yield Static(classes="timeout-unit", markup=False)
        yield Static(classes="timeout-bad", markup=False)

    @property
    def field(self) -> Field:
        """Where they are typed."""
        return self.query_one(Field)

    @property
    def seconds(self) -> float | None:
        """The seconds that stand there; None if nobody can wait so long."""
        try:
            typed_s = float(self.field.value.strip().replace(",", "."))
        except ValueError:
            return None
        return typed_s if math.isfinite(typed_s) and LEAST_S <= typed_s <= MOST_S else None

    def relabel(self) -> None:
        """Say everything in the language spoken now."""
        self.query_one(".timeout-label", Static).update(_("Wait for the answer"))
        self.query_one(".timeout-unit", Static).update(_("s"))
        limits = {"least": decimal(f"{LEAST_S:g}"), "greatest": f"{MOST_S:g}"}
        wrong = "" if self.seconds else "✗ " + _("{least} to {greatest} s").format(**limits)
        self.query_one(".timeout-bad", Static).update(wrong)

    def on_mount(self) -> None:
        """Say what it is."""
        self.relabel()

    @on(Input.Changed)
    def _changed(self, event: Input.Changed) -> None:
        event.stop()
        self.relabel()
