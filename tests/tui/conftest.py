"""What every test of the screen gets: colours, no motion, a clock that stands, English."""

from __future__ import annotations

import os

os.environ.update(
    TEXTUAL_ANIMATIONS="none", COLORTERM="truecolor", TEXTUAL_COLOR_SYSTEM="truecolor"
)
os.environ.pop("NO_COLOR", None)

from collections.abc import Iterator

import pytest

from tests.tui.recorded import NOW_S
from tui import clock
from tui.i18n import set_language


@pytest.fixture(autouse=True)
def _still(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Stop cursors and clocks, speak English, and set the language back afterwards."""
    monkeypatch.setattr(clock, "now", lambda: NOW_S + 17.0)
    monkeypatch.setenv("TZ", "UTC")
    set_language("en")
    yield
    set_language("en")
