"""The camera picture in half-blocks: its shape, and what is sent of it over a slow line."""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest
from textual.app import App, ComposeResult
from textual.geometry import Region

from tests.waiting import until
from tui.terminal.bandwidth import Bandwidth
from tui.terminal.pixels import PICTURE, Graphics, GraphicsChanged, Pixels
from tui.widgets.image_view import ImageView, fitting_size
from tui.widgets.image_view import Pixels as Rgb

RED, BLUE = (255, 0, 0), (0, 0, 255)


class PictureApp(App[None]):
    """A bare app with nothing but the picture."""

    def __init__(self, limit: int = 0) -> None:
        super().__init__()
        self.bandwidth = Bandwidth(limit)
        self.pixels = Pixels()

    def compose(self) -> ComposeResult:
        yield ImageView()

    @property
    def view(self) -> ImageView:
        return self.query_one(ImageView)


def plain_picture(width: int, height: int, color: tuple[int, int, int]) -> Rgb:
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


def ground(view: ImageView) -> tuple[int, int, int] | None:
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


def picture_columns(view: ImageView) -> int:
    """The width of the picture in pixels that is shown, 0 if there is none."""
    found = PICTURE.search(row_text(view, 4))
    return 0 if found is None else len(found[0])


def shows(view: ImageView, columns: int) -> bool:
    return picture_columns(view) == columns


async def test_with_cells_of_another_size_a_still_picture_is_made_anew() -> None:
    app = PictureApp()
    async with app.run_test(size=(50, 9)):
        app.view.show(plain_picture(16, 16, RED))
        for cell, columns in (((10, 20), 16), ((10, 10), 8)):
            app.pixels.graphics = Graphics("sixel", cell)
            app.view.post_message(GraphicsChanged())
            await until(partial(shows, app.view, columns), "the picture in pixels", 10)
        app.pixels.graphics = None
        app.view.post_message(GraphicsChanged())
        await until(lambda: not picture_columns(app.view), "the picture in half-blocks", 10)


async def test_a_picture_shown_after_words_while_another_is_on_its_way_into_pixels_is_shown() -> None:
    app = PictureApp()
    app.pixels.graphics = Graphics("sixel", (10, 20))
    async with app.run_test(size=(50, 9)):
        app.view.show(plain_picture(16, 16, RED))
        app.view.show_words("nothing")
        app.view.show(plain_picture(16, 16, BLUE))
        await until(lambda: picture_columns(app.view), "the picture in pixels")


async def test_pictures_that_come_while_one_is_on_its_way_into_pixels_count_as_left_out() -> None:
    app = PictureApp()
    app.pixels.graphics = Graphics("sixel", (10, 20))
    async with app.run_test(size=(50, 9)):
        for color in (RED, BLUE, RED):
            app.view.show(plain_picture(16, 16, color), "rgb8", hz="15")
        await until(lambda: " of 15 Hz" in app.view.caption, "the caption")


async def test_a_picture_in_pixels_waits_for_what_was_sent_while_it_was_made() -> None:
    app = PictureApp()
    app.pixels.graphics = Graphics("sixel", (10, 20))
    async with app.run_test(size=(50, 9)) as pilot:
        app.view.show(plain_picture(16, 16, RED))
        app.bandwidth.behind = True
        await pilot.pause(0.3)
        assert not picture_columns(app.view)
        app.bandwidth.behind = False
        await until(lambda: picture_columns(app.view), "the picture in pixels", 10)
