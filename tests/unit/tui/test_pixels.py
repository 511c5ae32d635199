"""True pixels: what the terminal's answers mean, and what becomes of keys between them."""

from __future__ import annotations

import numpy as np
import pytest

from tui.terminal.pixels import (
    FIRST,
    Graphics,
    PixelPicture,
    Pixels,
    are_wanted,
    encoded,
    graphics_of,
    in_multiplexer,
    most_bytes,
)
from tui.terminal.terminal_diff import TerminalDiff
from tui.widgets.canvas import Canvas
from tui.widgets.drawing import LOOKS

CELL, KITTY = "\x1b[6;20;10t", "\x1b_Gi=1;OK\x1b\\"
XTERM = ("\x1b[?1;0;256S", "\x1b[?2;0;1000;800S", "\x1b[?63;1;2;4;6;9;15;16;22;28c")
ONE = chr(FIRST)


@pytest.mark.parametrize(
    ("answers", "graphics"),
    [
        (XTERM, Graphics("sixel", (10, 20), 256, (1000, 800))),
        ((CELL, "\x1b[?62;4;22c"), Graphics("sixel", (10, 20))),
        ((KITTY, CELL, "\x1b[?62;c"), Graphics("kitty", (10, 20))),
        ((KITTY, CELL, "\x1b[?65;4;6c"), Graphics("sixel", (10, 20))),
        (("\x1b_Gi=1;ENOTSUPPORTED:\x1b\\", CELL, "\x1b[?62;c"), None),
        ((CELL, "\x1b[?1;0;16S", "\x1b[?63;4c"), None),
        (("\x1b[?62;4;22c",), None),
        ((CELL, "\x1b[?4;6c"), None),
        ((CELL, "\x1b[?64;1;2;6;9;15;16;17;18;21;22;28c"), None),
        ((), None),
    ],
    ids=["xterm", "foot", "kitty", "both", "refused", "few-colours", "no-cell", "a-level", "xterm-vt420", "silent"],
)
def test_what_a_terminal_answers_says_whether_it_has_pixels(
    answers: tuple[str, ...], graphics: Graphics | None
) -> None:
    # What the system knows of xterm, which does not tell it.
    assert graphics_of("".join(answers), (10, 20) if answers == XTERM else (0, 0)) == graphics


@pytest.mark.parametrize(
    ("wish", "limit", "wanted"),
    [("", 0, True), ("auto", 0, True), ("auto", 40_000, False), ("on", 40_000, True), ("off", 0, False)],
)
def test_over_a_limited_line_they_are_asked_for_only_on_request(wish: str, limit: int, wanted: bool) -> None:
    assert are_wanted(wish, limit) is wanted


@pytest.mark.parametrize(
    ("env", "is_one"),
    [({"TMUX": "/x"}, True), ({"STY": "1.x"}, True), ({"TERM": "tmux-256color"}, True), ({"TERM": "foot"}, False)],
)
def test_in_a_multiplexer_kittys_question_would_be_a_title(env: dict[str, str], is_one: bool) -> None:
    assert in_multiplexer(env) is is_one


@pytest.mark.parametrize("size", [1, 2, 7, 1000])
def test_keys_between_answers_are_kept_however_it_comes_in_pieces(size: int) -> None:
    pixels = Pixels(wanted=True)
    pixels.asked()
    typed = f"a {KITTY} {CELL}\x1b[A{XTERM[0]}\x1b[?2026;2$y\x1bb{XTERM[2]} z"
    keys = "".join(pixels.sift(typed[at : at + size]) for at in range(0, len(typed), size))
    assert keys == "a  \x1b[A\x1b[?2026;2$y\x1bb z"
    assert pixels.graphics == Graphics("sixel", (10, 20))


def test_with_two_questions_open_both_answers_are_taken_and_none_is_typed() -> None:
    pixels = Pixels(wanted=True)
    pixels.asked()
    assert pixels.sift(f"{KITTY}{CELL}") == ""
    pixels.asked()
    assert pixels.sift("\x1b[?62;c") == ""
    assert pixels.graphics == Graphics("kitty", (10, 20))
    assert pixels.sift(f"{KITTY}\x1b[6;40;20t\x1b[?62;ca") == "a"
    assert pixels.graphics == Graphics("kitty", (20, 40))
    assert pixels.sift(KITTY) == KITTY


def test_with_cells_of_another_size_there_are_no_pixels_until_the_terminal_has_answered() -> None:
    pixels = Pixels(wanted=True)
    pixels.asked((10, 20))
    pixels.sift("\x1b[?62;4c")
    pixels.asked((10, 20))
    assert pixels.graphics == Graphics("sixel", (10, 20))
    pixels.asked((12, 24))
    assert [pixels.graphics] == [None]
    pixels.sift(2 * "\x1b[?62;4c")
    assert pixels.graphics == Graphics("sixel", (12, 24))


def test_without_a_question_nothing_is_taken_for_an_answer() -> None:
    assert Pixels().sift(f"{KITTY}\x1b") == f"{KITTY}\x1b"


def picture(char: str) -> PixelPicture:
    return PixelPicture(char, f"<{ord(char) - FIRST}>", "<erased>", np.full((4, 3, 3), 7, np.uint8))


def cells(char: str, rows: tuple[int, ...] = (1, 2)) -> str:
    return "".join(f"\x1b[{row + 1};2H\x1b[31m{char * 3}\x1b[0m" for row in rows)


def test_a_picture_is_drawn_when_all_of_it_shows_and_in_half_blocks_when_something_covers_it() -> None:
    two = chr(FIRST + 1)
    diff = TerminalDiff({ONE: picture(ONE), two: picture(two)})
    diff.forget(10, 5)
    assert "<0>" in diff.changes(cells(ONE))
    assert diff.changes(cells(ONE)) == ""
    covered = diff.changes("\x1b[2;2Hx")
    assert "<erased>" in covered
    assert covered.count("▀") == 5
    assert "<0>" in diff.changes(cells(ONE, (1,)))
    assert "<erased>" in diff.changes("\x1b[2;2Hx")
    anew = diff.changes(cells(two, (2,)))
    assert "\x1b[3;2H" in anew
    assert anew.count("▀") == 3
    diff.changes(cells(ONE))
    replaced = diff.changes(cells(two))
    assert replaced.index("<1>") < replaced.index("<erased>")
    assert "▀" not in replaced
    left = diff.changes("\x1b[2;1Hwords\x1b[3;1Hwords")
    assert "<erased>" in left
    assert "▀" not in left


def test_text_of_uncertain_width_left_of_a_picture_does_not_erase_it() -> None:
    diff = TerminalDiff({ONE: picture(ONE)})
    diff.forget(10, 5)
    diff.changes(cells(ONE))
    beside = diff.changes("\x1b[2;1H\u0e01")
    assert "<erased>" not in beside
    assert "<0>" in beside
    assert "<erased>" in diff.changes("\x1b[2;2H界")


def test_a_picture_in_the_last_row_is_not_drawn_in_pixels_as_the_screen_would_scroll() -> None:
    diff = TerminalDiff({ONE: picture(ONE)})
    diff.forget(10, 3)
    drawn = diff.changes(cells(ONE))
    assert "<0>" not in drawn
    assert drawn.count("▀") == 6


def test_a_picture_is_encoded_for_just_its_cells() -> None:
    rgb = np.full((30, 40, 3), 200, np.uint8)
    sixels, erase = encoded(rgb, (4, 2), ONE, Graphics("sixel", (10, 20)))
    assert sixels.startswith('\x1bP0;0;0q"1;1;40;40')
    assert sixels.endswith("\x1b\\")
    assert erase == ""
    kitty, erase = encoded(rgb, (4, 2), ONE, Graphics("kitty", (10, 20)))
    assert kitty.startswith("\x1b_Ga=T,f=100,i=1,p=1,c=4,r=2,C=1,q=2,m=0;")
    assert erase == "\x1b_Ga=d,d=I,i=1,q=2\x1b\\"


async def test_noise_that_would_fill_the_line_is_not_sent() -> None:
    noise = np.random.default_rng(1).integers(0, 256, (500, 800, 3), np.uint8)
    pixels, halves = Pixels(graphics=Graphics("sixel", (10, 20))), np.zeros((50, 80, 3), np.uint8)
    assert await pixels.made(noise, halves) is None
    assert await pixels.made(noise // 255, halves) is not None
    pixels.most_bytes = most_bytes(100)
    assert await pixels.made(noise // 255, halves) is None
    assert most_bytes(0) == most_bytes(1_000_000) > most_bytes(40_000)


def test_each_dot_of_a_canvas_in_pixels_has_its_own_colour_and_a_sign_is_a_spot() -> None:
    canvas = Canvas(8, 4)
    canvas.line((0, 0), (15, 0), "good")
    canvas.sign((8, 12), "●", "bad")
    rgb = canvas.rgb({look: (at, 9, 9) for at, look in enumerate(("", *LOOKS))}, (0, 0, 0))
    assert rgb.shape == (16, 16, 3)
    good, bad = 1 + LOOKS.index("good"), 1 + LOOKS.index("bad")
    assert rgb[0, 0].tolist() == [good, 9, 9]
    assert rgb[12, 8].tolist() == [bad, 9, 9]
    assert rgb[5, 5].tolist() == [0, 0, 0]
