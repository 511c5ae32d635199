"""How much of a picture may go to the terminal, and when: by a clock that the test moves."""

from __future__ import annotations

import pytest

from tui.terminal.bandwidth import (
    MOST_DEBT_S,
    OVER_SSH,
    SAVED_S,
    Bandwidth,
    PicturePace,
    default_limit,
)


class Clock:
    """Stands still until it is moved."""

    def __init__(self) -> None:
        self.now_s = 100.0

    def __call__(self) -> float:
        return self.now_s


@pytest.mark.parametrize(
    ("env", "limit"),
    [({}, 0), ({"SSH_CONNECTION": ""}, 0), ({"SSH_CONNECTION": "::1 1 ::1 22"}, 40_000)],
)
def test_there_is_a_limit_over_ssh_alone(env: dict[str, str], limit: int) -> None:
    assert default_limit(env) == limit


def test_without_a_limit_nothing_waits() -> None:
    bandwidth = Bandwidth(0, Clock())
    bandwidth.written(10**9)
    assert bandwidth.wait_s() == 0


def test_a_picture_waits_until_what_was_written_is_earned() -> None:
    clock = Clock()
    bandwidth = Bandwidth(40_000, clock)
    bandwidth.written(10_000 + 20_000)
    assert bandwidth.wait_s() == pytest.approx(0.5)
    clock.now_s += 0.4
    assert bandwidth.wait_s() == pytest.approx(0.1)
    clock.now_s += 0.1 + 1e-9
    assert bandwidth.wait_s() == 0


@pytest.mark.parametrize("size", [300, 5_000, 70_000])
def test_pictures_of_any_size_keep_to_the_limit(size: int) -> None:
    clock = Clock()
    bandwidth = Bandwidth(OVER_SSH, clock)
    written, pictures = 0, 0
    while clock.now_s < 160:
        if not (wait_s := bandwidth.wait_s()):
            bandwidth.written(size)
            written, pictures = written + size, pictures + 1
            wait_s = 1 / 200
        clock.now_s += wait_s
    assert written <= OVER_SSH * (60 + SAVED_S) + size
    assert written >= min(OVER_SSH * 60, 60 * 200 * size) * 0.95


def test_what_a_rest_saves_is_little() -> None:
    clock = Clock()
    bandwidth = Bandwidth(OVER_SSH, clock)
    clock.now_s += 3600
    bandwidth.written(OVER_SSH)
    assert bandwidth.wait_s() == pytest.approx(1 - SAVED_S)


def test_text_alone_starves_no_picture_for_ever() -> None:
    bandwidth = Bandwidth(1_000, Clock())
    for _ in range(100):
        bandwidth.written(1_000_000)
    assert bandwidth.wait_s() == pytest.approx(MOST_DEBT_S)


@pytest.mark.parametrize("limit", [0, OVER_SSH])
def test_no_picture_goes_to_a_terminal_that_has_not_taken_the_last(limit: int) -> None:
    bandwidth = Bandwidth(limit, Clock())
    bandwidth.behind = True
    assert bandwidth.wait_s() > 0
    assert bandwidth.is_slow
    bandwidth.behind = False
    assert bandwidth.wait_s() == 0


def test_the_rate_is_that_of_the_pictures_shown_while_others_are_left_out() -> None:
    pace = PicturePace()
    for number in range(20):
        pace.shown(number / 2)
    assert pace.limited_hz(9.5) is None
    pace.left_out(9.4)
    assert pace.limited_hz(9.5) == pytest.approx(2)
    assert pace.limited_hz(60) is None


def test_a_pause_of_the_stream_does_not_count_as_slowness() -> None:
    pace = PicturePace()
    for time_s in (0.0, 1.0, 100.0, 100.5, 101.0):
        pace.shown(time_s)
    pace.left_out(101.0)
    assert pace.limited_hz(101.0) == pytest.approx(2)
