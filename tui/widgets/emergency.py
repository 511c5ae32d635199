"""The emergency stop in red and in words, until it is released."""

from __future__ import annotations

from textual.content import Content
from textual.widget import Widget

from tui.emergency import Emergency
from tui.i18n import _


class EmergencyBanner(Widget):
    """Hidden while it is not engaged."""

    DEFAULT_CSS = """
    EmergencyBanner {
        display: none;
        width: 1fr;
        height: auto;
        max-height: 3;
        padding: 0 1;
        text-align: center;
        &.-engaged {
            display: block;
            background: #b00020;
            color: #ffffff;
            text-style: bold;
        }
    }
    """

    def __init__(self) -> None:
        super().__init__()
        self._emergency = Emergency()
        self._release_key = ""

    def show(self, emergency: Emergency, release_key: str) -> None:
        """Show `emergency`; `release_key` is what the banner tells people to press."""
        if (emergency, release_key) == (self._emergency, self._release_key):
            return
        self._emergency, self._release_key = emergency, release_key
        self.set_class(emergency.engaged, "-engaged")
        self.refresh(layout=True)

    def render(self) -> Content:
        """Say what is stopped, why, and how to go on."""
        state = self._emergency
        words = _("■ EMERGENCY STOP") if state.ours else _("■ EMERGENCY STOP (by another)")
        if state.fallback:
            words += " · " + _(state.fallback)
        release = _("{key} releases").format(key=self._release_key)
        return Content(f"{words} · {release}")
