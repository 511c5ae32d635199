"""What the Deck looks like: at work, in trouble, stopped, in the first and in the LLM lesson."""

from __future__ import annotations

from typing import Any

from textual.pilot import Pilot

from tests.tui.lesson_openers import hello, llm, troubled
from tests.tui.snapshots import Look, SnapCompare, every_look, one_look


@every_look
def test_deck_looks(look: Look, snap_compare: SnapCompare) -> None:
    """Eight nodes ready, sonar 1.84 m free, left turn, colour bars, head 45° left, the log."""
    assert snap_compare(look.app(), terminal_size=look.size, run_before=look.settle)


@one_look
def test_deck_of_the_first_lesson_looks(look: Look, dump_compare: SnapCompare) -> None:
    """One node above, its log below over the whole width, no panels and no empty frames."""
    assert dump_compare(look.app(opener=hello()), terminal_size=look.size, run_before=look.settle)


@one_look
def test_deck_of_the_llm_lesson_looks(look: Look, dump_compare: SnapCompare) -> None:
    """Accepted, the drive, the head done: the trail of the newest JSON with its delays."""
    assert dump_compare(look.app(opener=llm()), terminal_size=look.size, run_before=look.settle)


@one_look
def test_deck_in_trouble_looks(look: Look, dump_compare: SnapCompare) -> None:
    """Failed, restarting and waiting nodes by sign and word; each empty panel says why."""
    assert dump_compare(
        look.app(opener=troubled()), terminal_size=look.size, run_before=look.settle
    )


@one_look
def test_deck_stopped_looks(look: Look, dump_compare: SnapCompare) -> None:
    """The red line with the word and the key that releases stands under the title."""

    async def stop(pilot: Pilot[Any]) -> None:
        await look.settle(pilot)
        await pilot.press("space")

    assert dump_compare(look.app(), terminal_size=look.size, run_before=stop)
