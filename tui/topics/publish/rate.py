"""The rate of a publication, and beside it the result of the last action."""

from __future__ import annotations

from typing import TYPE_CHECKING

from textual import on
from textual.containers import Horizontal
from textual.message import Message
from textual.widgets import Input, Static

from graph.publishing.outbox import LEAST_HZ, MOST_HZ
from text.i18n import _, decimal
from text.plain import plain
from tui.widgets.field import Field

if TYPE_CHECKING:
    from collections.abc import Callable

    from textual.app import ComposeResult

LONGEST = 300


class PublishRate(Horizontal):
    """A field for the rate, and on its right a remark in the current language."""

    class RateDone(Message):
        """Enter was pressed in the field."""

    DEFAULT_CSS = """
    PublishRate {
        height: auto;
        #rate-label { width: 8; color: $text-muted; }
        #rate-hz { width: 8; }
        #rate-unit { width: auto; padding: 0 2 0 0; color: $text-muted; }
        #rate-said { width: 1fr; height: auto; max-height: 3; }
        #rate-said.-good { color: $text-success; }
        #rate-said.-bad { color: $text-error; text-style: bold; }
    }
    """

    def __init__(self) -> None:
        super().__init__()
        self._words: Callable[[], str] = lambda: ""
        self._look = ""

    def compose(self) -> ComposeResult:
        yield Static(id="rate-label", markup=False)
        yield Field("10", id="rate-hz", compact=True, select_on_focus=False)
        yield Static(id="rate-unit", markup=False)
        yield Static(id="rate-said", markup=False)

    def on_mount(self) -> None:
        self.on_language_changed()

    @property
    def field(self) -> Input:
        return self.query_one(Input)

    @property
    def says_bad(self) -> bool:
        """Whether the remark reports a failure."""
        return self._look == "bad"

    def rate_hz(self) -> float | None:
        """Return the rate; if it is invalid, say what is allowed and return None."""
        try:
            hz = float(self.field.value.replace(",", "."))
        except ValueError:
            hz = 0.0
        if LEAST_HZ <= hz <= MOST_HZ:
            return hz
        self.tell(_limits, "bad")
        self.field.focus()
        return None

    def tell(self, words: Callable[[], str], look: str = "") -> None:
        """Show a remark as `good`, `bad` or neither; `words` is called again in a new language."""
        self._words, self._look = words, look
        shown = self.query_one("#rate-said", Static)
        shown.set_class(look == "good", "-good")
        shown.set_class(look == "bad", "-bad")
        shown.update(plain(words(), LONGEST))

    def on_language_changed(self) -> None:
        self.query_one("#rate-label", Static).update(_("Rate"))
        self.query_one("#rate-unit", Static).update(_("Hz"))
        self.tell(self._words, self._look)

    @on(Input.Submitted)
    def _submitted(self, event: Input.Submitted) -> None:
        event.stop()
        self.post_message(self.RateDone())


def _limits() -> str:
    limits = {"least": decimal(f"{LEAST_HZ:g}"), "greatest": f"{MOST_HZ:g}"}
    return _("The rate is {least} to {greatest} Hz.").format(**limits)
