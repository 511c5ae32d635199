"""Snapshots of a screen at three terminal sizes and in both languages.

::

    @every_look
    def test_logs(look: Look, snap_compare: SnapCompare) -> None:
        '''Newest lines at the bottom, warnings marked by a word and a colour.'''
        assert snap_compare(look.app("logs"), terminal_size=look.size, run_before=look.settle)

`snap_compare` keeps an SVG, for the main state of a screen and for what is drawn; `dump_compare`
(`tests.tui.text_dump`) is called in the same way and keeps text and styles, for all else.
The recorded session and graph are those of `tests.tui.recorded`; the clock stands still
(`frozen_clock` in conftest), nothing blinks, nothing is animated.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from textual.pilot import Pilot

from tests.tui.recorded import RecordedOpener
from tests.waiting import until
from text.i18n import set_language
from tui.app import DeckApp
from tui.dialogs.dialog import Dialog
from tui.picker.screen import PickerScreen
from tui.session.requests import OpenRequest
from tui.widgets.rows import Rows

SnapCompare = Callable[..., bool]
SIZES = ((80, 24), (120, 40), (200, 60))
LANGUAGES = ("en", "ru")


@dataclass(frozen=True)
class Look:
    """One size and one language."""

    size: tuple[int, int]
    language: str

    def app(self, screen: str = "deck", opener: RecordedOpener | None = None) -> DeckApp:
        """Return an app with the recorded lesson 9 opened, that will show `screen`."""
        set_language(self.language)
        order = OpenRequest() if screen == "picker" else OpenRequest(Path("profiles/09-brain.yaml"))
        return DeckApp(opener or RecordedOpener(), order, screen)

    @staticmethod
    async def settle(pilot: Pilot[Any]) -> None:
        """Wait until what was recorded is on the screen."""
        await settle(pilot)


async def settle(pilot: Pilot[Any]) -> None:
    """Wait until the recorded session, the picker or a question is there and all is handled."""
    app = pilot.app
    assert isinstance(app, DeckApp)
    await pilot.pause()
    await until(lambda: app._exit or app.feed.update or _asks(app), "what was recorded")
    for _round in range(3):
        await pilot.pause()


def _asks(app: DeckApp) -> bool:
    """Whether a dialog is in front, or the picker with its lessons."""
    if isinstance(app.screen, PickerScreen):
        return any(rows.chosen for rows in app.screen.query(Rows))
    return isinstance(app.screen, Dialog)


def _looks(chosen: Sequence[tuple[tuple[int, int], str]]) -> pytest.MarkDecorator:
    return pytest.mark.parametrize(
        "look",
        [
            pytest.param(Look(size, language), id=f"{size[0]}x{size[1]}-{language}")
            for size, language in chosen
        ],
    )


every_look = _looks([(size, language) for size in SIZES for language in LANGUAGES])
both_languages = _looks(list(zip(SIZES[:2], LANGUAGES, strict=True)))
"""For a state of a screen of which `every_look` is shown already: narrow and in Russian."""
one_look = _looks([(SIZES[0], LANGUAGES[0])])
"""For a secondary state, as a dialog, an error or a filter: narrow and in English."""
