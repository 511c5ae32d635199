"""A session that has lost its guardian: said in every title for as long as it runs."""

from __future__ import annotations

import pytest

from launcher.events import UnguardedEvent
from tests.tui.recorded import RecordedOpener
from tests.tui.recorded_emergency import held
from tests.tui.snapshots import opened, settle
from text.i18n import set_language
from tui.frame.title_bar import TitleBar


@pytest.mark.parametrize(
    ("language", "words"),
    [
        ("en", "⚠ The guardian process is dead: start the session anew"),
        ("ru", "⚠ Сторожевой процесс завершился: начните сеанс заново"),
    ],
)
async def test_a_dead_guardian_stands_in_the_title(language: str, words: str) -> None:
    set_language(language)
    opener = RecordedOpener()
    async with opened(opener, size=(80, 24)) as (app, pilot):
        assert words not in app.screen.query_one(TitleBar).text
        opener.link.say(UnguardedEvent())
        await settle(pilot)
        await pilot.press("2")
        await settle(pilot)
        title = app.screen.query_one(TitleBar).text
        assert words in title
        assert "…" not in title


async def test_what_holds_the_wheels_comes_before_it() -> None:
    opener = RecordedOpener()
    async with opened(opener) as (app, pilot):
        opener.link.say(UnguardedEvent())
        opener.graph.show(held(b"\x01", "front 0.38 m"))
        await settle(pilot)
        assert "⚠ Front 0.38 m" in app.screen.query_one(TitleBar).text
