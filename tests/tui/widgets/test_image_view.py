"""The camera picture in half-blocks: its shape, its words when there is none, and what it costs."""

from __future__ import annotations

import re
import subprocess
import sys
from typing import TYPE_CHECKING

import numpy as np
import pytest
from textual.app import App, ComposeResult
from textual.geometry import Region

from tests.waiting import until
from tui.terminal.bandwidth import Bandwidth
from tui.widgets.half_blocks import changed_spans, coarser, fitting_size
from tui.widgets.image_view import ImageView

if TYPE_CHECKING:
    from tui.widgets.half_blocks import Pixels

RED, BLUE = (255, 0, 0), (0, 0, 255)


class PictureApp(App[None]):
    """A bare app with nothing but the picture."""

    def __init__(self, limit: int = 0) -> None:
        super().__init__()
        self.bandwidth = Bandwidth(limit)

    def compose(self) -> ComposeResult:
        """The picture fills the screen."""
        yield ImageView()

    @property
    def view(self) -> ImageView:
        """The picture."""
        return self.query_one(ImageView)


def plain_picture(width: int, height: int, color: tuple[int, int, int]) -> Pixels:
    return np.full((height, width, 3), color, np.uint8)


def row_text(view: ImageView, y: int) -> str:
    return view.render_line(y).text


def repaints(view: ImageView, monkeypatch: pytest.MonkeyPatch) -> list[tuple[Region, ...]]:
    """Every later `refresh` of the view with the regions it asks for."""
    asked: list[tuple[Region, ...]] = []

    def refresh(*regions: Region, **_options: bool) -> ImageView:
        asked.append(regions)
        return view

    monkeypatch.setattr(view, "refresh", refresh)
    return asked


@pytest.mark.parametrize(
    ("picture", "room", "expected"),
    [
        ((640, 480), (80, 24), (64, 48)),
        ((640, 480), (40, 24), (40, 30)),
        ((480, 640), (80, 24), (36, 48)),
        ((4, 4), (80, 24), (48, 48)),
        ((10_000, 1), (80, 24), (80, 2)),
        ((1, 10_000), (80, 24), (1, 48)),
    ],
)
def test_the_largest_picture_that_fits_keeps_its_shape(
    picture: tuple[int, int], room: tuple[int, int], expected: tuple[int, int]
) -> None:
    assert fitting_size(*picture, *room) == expected


def test_fewer_bits_keep_black_and_white() -> None:
    ramp = np.arange(256, dtype=np.uint8)[:, None, None].repeat(3, 2)
    coarse = coarser(ramp, 3)
    assert (coarse[0] == 0).all()
    assert (coarse[255] == 255).all()
    assert len(np.unique(coarse)) == 8
    assert np.abs(coarse.astype(int) - ramp).max() <= 20


def test_changes_close_together_are_one_span() -> None:
    before = plain_picture(40, 4, BLUE)
    after = before.copy()
    after[3, [5, 8, 30]] = RED
    assert changed_spans(before, after) == [(1, 5, 4), (1, 30, 1)]


async def test_upper_and_lower_pixels_are_fore_and_background() -> None:
    app = PictureApp()
    async with app.run_test(size=(10, 6)):
        two = plain_picture(10, 10, RED)
        two[1::2] = BLUE
        app.view.show(two, "bgr8 10×10")
        segment = next(iter(app.view.render_line(0)))
        assert segment.text == "▀" * 10
        assert segment.style is not None
        assert segment.style.color is not None
        assert segment.style.bgcolor is not None
        assert segment.style.color.triplet == RED
        assert segment.style.bgcolor.triplet == BLUE
        assert row_text(app.view, 5) == "bgr8 10×10"


async def test_the_picture_stands_in_the_middle() -> None:
    app = PictureApp()
    async with app.run_test(size=(20, 5)):
        app.view.show(plain_picture(8, 8, RED))
        widths = [len(segment.text) for segment in app.view.render_line(0)]
        assert widths == [6, 8, 6]


async def test_the_same_picture_again_draws_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    app = PictureApp()
    async with app.run_test(size=(20, 8)):
        app.view.show(plain_picture(64, 48, RED), "10 Hz")
        asked = repaints(app.view, monkeypatch)
        app.view.show(plain_picture(64, 48, RED), "10 Hz")
        assert asked == []


async def test_only_the_cells_that_changed_are_drawn(monkeypatch: pytest.MonkeyPatch) -> None:
    app = PictureApp()
    async with app.run_test(size=(16, 9)):
        picture = plain_picture(16, 16, RED)
        app.view.show(picture)
        asked = repaints(app.view, monkeypatch)
        moved = picture.copy()
        moved[4:6, 3] = BLUE
        app.view.show(moved)
        assert asked == [(Region(3, 2, 1, 1),)]


async def test_camera_noise_draws_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    app = PictureApp()
    async with app.run_test(size=(16, 9)):
        noise = np.random.default_rng(7)
        picture = noise.integers(20, 230, (16, 16, 3), np.uint8)
        app.view.show(picture)
        asked = repaints(app.view, monkeypatch)
        for _ in range(20):
            app.view.show((picture + noise.integers(-3, 4, picture.shape)).astype(np.uint8))
        assert asked == []


def ground(view: ImageView) -> tuple[int, int, int] | None:
    """The colour of the picture's first cell."""
    room = view.rich_style.bgcolor
    colors = [seg.style.bgcolor for seg in view.render_line(0) if seg.style is not None]
    return next(color.triplet for color in colors if color is not None and color != room)


async def test_of_those_that_come_while_the_line_is_busy_the_newest_alone_is_shown() -> None:
    app = PictureApp()
    async with app.run_test(size=(50, 9)):
        app.view.show(plain_picture(16, 16, RED), "rgb8", hz="15")
        app.bandwidth.behind = True
        for color in ((0, 255, 0), (255, 255, 0), BLUE):
            app.view.show(plain_picture(16, 16, color), "rgb8", hz="15")
            assert ground(app.view) == RED
        app.bandwidth.behind = False
        await until(lambda: ground(app.view) == BLUE, "the newest picture")
        assert " of 15 Hz: the terminal is slow" in app.view.caption


async def test_beyond_the_limit_a_picture_waits_and_the_caption_says_how_many_are_shown() -> None:
    app = PictureApp(40_000)
    async with app.run_test(size=(60, 9)):
        app.view.show(plain_picture(16, 16, RED), "rgb8", hz="15")
        assert app.view.caption == "rgb8 · 15 Hz"
        app.bandwidth.written(30_000)
        app.view.show(plain_picture(16, 16, (0, 255, 0)), "rgb8", hz="15")
        app.view.show(plain_picture(16, 16, BLUE), "rgb8", hz="15")
        assert ground(app.view) == RED
        await until(lambda: ground(app.view) == BLUE, "the newest picture")
        assert re.fullmatch(r"rgb8 · \d+\.\d of 15 Hz: limited to 40 kB/s", app.view.caption)


async def test_words_do_not_wait_and_no_older_picture_comes_after_them() -> None:
    app = PictureApp(1_000)
    async with app.run_test(size=(40, 9)) as pilot:
        app.view.show(plain_picture(16, 16, RED))
        app.bandwidth.written(600)
        app.view.show(plain_picture(16, 16, BLUE))
        app.view.show_words("no publisher")
        await until(lambda: not app.bandwidth.wait_s(), "the line free")
        await pilot.pause()
        assert app.view.words == ("no publisher", "")
        assert not app.view.has_picture
        app.bandwidth.written(10_000)
        app.view.show(plain_picture(16, 16, BLUE))
        assert ground(app.view) == BLUE  # The first of a stream is awaited.


async def test_a_picture_that_waits_is_drawn_with_a_new_size() -> None:
    app = PictureApp(1_000)
    async with app.run_test(size=(40, 9)) as pilot:
        app.view.show(plain_picture(16, 16, RED))
        app.bandwidth.written(100_000)
        app.view.show(plain_picture(16, 16, BLUE))
        await pilot.resize_terminal(60, 20)
        await pilot.pause()
        assert ground(app.view) == BLUE


async def test_words_stand_in_place_of_a_picture_and_go_when_one_comes() -> None:
    app = PictureApp()
    async with app.run_test(size=(30, 7)) as pilot:
        app.view.show_words("no publisher", "nobody publishes /camera/color/image_raw")
        await pilot.pause()
        text = "\n".join(row_text(app.view, y).strip() for y in range(7))
        assert "no publisher\nnobody publishes" in text
        assert not app.view.has_picture
        app.view.show(plain_picture(8, 8, RED))
        assert app.view.words == ("", "")
        assert app.view.has_picture


async def test_hostile_words_are_shown_as_pictures_of_their_controls() -> None:
    app = PictureApp()
    async with app.run_test(size=(60, 5)) as pilot:
        app.view.show_words("[red]cannot[/red] \x1b]52;c;YQ==\x07", "\ud800\u202e\x9b31m")
        await pilot.pause()
        text = "\n".join(row_text(app.view, y) for y in range(5))
        assert "[red]cannot[/red] ␛]52;c;YQ==␇" in text
        assert not any(char in text for char in "\x1b\x07\x9b\u202e\ud800")


@pytest.mark.parametrize("size", [(1, 1), (2, 3), (5, 2), (80, 24), (200, 60)])
async def test_every_line_fills_its_width_at_any_size(size: tuple[int, int]) -> None:
    app = PictureApp()
    async with app.run_test(size=size) as pilot:
        app.view.show_words("no publisher", "wait for it")
        for _ in range(2):
            lines = [app.view.render_line(y) for y in range(app.view.size.height)]
            assert {line.cell_length for line in lines} == {app.view.size.width}
            app.view.show(plain_picture(640, 480, RED), "rgb8 640×480 · 29.9 Hz")
            await pilot.pause()


async def test_a_resize_fits_the_picture_anew() -> None:
    app = PictureApp()
    async with app.run_test(size=(40, 13)) as pilot:
        app.view.show(plain_picture(640, 480, RED))
        await pilot.resize_terminal(80, 25)
        await pilot.pause()
        assert [len(segment.text) for segment in app.view.render_line(3)] == [8, 64, 8]


def test_the_widget_costs_no_numpy_before_there_is_a_picture() -> None:
    code = "import sys, tui.widgets.image_view; sys.exit('numpy' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


async def test_an_array_that_is_no_picture_is_refused() -> None:
    app = PictureApp()
    async with app.run_test():
        with pytest.raises(ValueError, match="shape"):
            app.view.show(np.zeros((4, 4), np.uint8))
