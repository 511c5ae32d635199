"""Who drives: ranked sources, how old a command may be, and what never revives."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot.safety.sources import HELD_AGE_S, Sources
from robot.words import STOP, DriveSetpoint

KEYS, ACTION, WORDS = "/drive_teleop", "/drive_action", "/drive"
RANKED = (KEYS, ACTION, WORDS)
FAST, SLOW = DriveSetpoint(0.5, 0.0), DriveSetpoint(0.1, 0.0)


def driver(sources: Sources, now_s: float) -> str:
    order = sources.driving(now_s)
    return order.source if order else ""


def test_the_first_in_rank_drives_as_long_as_its_command_is_young() -> None:
    sources = Sources(RANKED, max_age_s=0.5)
    assert driver(sources, 0.0) == ""
    assert sources.hear(WORDS, FAST, 0.0).source == WORDS
    assert sources.hear(KEYS, SLOW, 0.1).source == KEYS
    assert sources.hear(WORDS, FAST, 0.2).source == KEYS, "ignored"
    assert sources.hear(ACTION, FAST, 0.3).source == KEYS, "ignored"
    assert driver(sources, 0.599) == KEYS
    assert driver(sources, 0.601) == ACTION, "its own command is younger than that"
    assert driver(sources, 0.801) == ""


def test_what_was_said_long_ago_does_not_revive() -> None:
    sources = Sources(RANKED, max_age_s=0.5)
    sources.hear(WORDS, FAST, 0.0)
    for step in range(10):
        sources.hear(KEYS, SLOW, 0.1 * step)
    assert driver(sources, 1.3) == KEYS
    assert driver(sources, 1.5) == ""


@pytest.mark.parametrize("longer_s", [10.0, 0.0])
def test_a_longer_age_revives_nothing_that_was_too_old(longer_s: float) -> None:
    sources = Sources(RANKED, max_age_s=0.5)
    sources.hear(ACTION, FAST, 0.0)
    sources.hear(WORDS, FAST, 0.2)
    sources.let_age(longer_s, 0.6)
    assert driver(sources, 0.6) == WORDS, "it was young enough"
    sources.let_age(0.5, 0.6)
    assert driver(sources, 0.8) == ""
    sources.let_age(longer_s, 0.8)
    assert driver(sources, 0.8) == ""


def test_a_person_who_asks_for_a_stop_is_obeyed_too() -> None:
    sources = Sources(RANKED, max_age_s=0.5)
    sources.hear(WORDS, FAST, 0.0)
    assert sources.hear(KEYS, STOP, 0.1).setpoint == STOP
    assert driver(sources, 0.4) == KEYS


def test_a_corrected_order_keeps_its_age() -> None:
    sources = Sources(RANKED, max_age_s=0.5)
    order = sources.hear(WORDS, FAST, 0.0)
    sources.correct(order, STOP)
    kept = sources.driving(0.4)
    assert kept is not None
    assert kept.setpoint == STOP
    assert kept.age_s(0.4) == pytest.approx(0.4)
    assert sources.driving(0.6) is None
    sources.hear(WORDS, SLOW, 0.7)
    sources.correct(order, STOP)
    newest = sources.driving(0.7)
    assert newest is not None
    assert newest.setpoint == SLOW, "a newer one is not corrected for the old one's sake"


def test_after_forgetting_everybody_has_to_ask_anew() -> None:
    sources = Sources(RANKED, max_age_s=0.5)
    sources.hear(WORDS, FAST, 0.0)
    sources.hear(KEYS, FAST, 0.0)
    sources.forget()
    assert driver(sources, 0.0) == ""


def test_without_an_age_a_source_holds_until_it_asks_for_a_stop() -> None:
    sources = Sources(RANKED, max_age_s=0.0)
    sources.hear(KEYS, SLOW, 0.0)
    assert sources.hear(WORDS, FAST, 100.0).source == KEYS
    assert sources.hear(KEYS, STOP, 200.0).source == KEYS
    order = sources.driving(300.0)
    assert order is not None
    assert order.setpoint == STOP, "what the ignored one said before does not revive"
    assert sources.hear(WORDS, FAST, 400.0).source == WORDS
    assert driver(sources, 1e9) == WORDS


heard = st.lists(
    st.tuples(
        st.sampled_from(RANKED),
        st.builds(DriveSetpoint, st.sampled_from([-0.3, 0.0, 0.3]), st.just(0.1)),
        st.floats(0, 1),
    ),
    max_size=20,
)


@given(heard, st.sampled_from([0.1, 0.5, 2.0]), st.floats(0, 3))
def test_whoever_drives_is_the_first_whose_newest_command_is_young_enough(
    said: list[tuple[str, DriveSetpoint, float]], max_age_s: float, after_s: float
) -> None:
    sources, now_s = Sources(RANKED, max_age_s), 0.0
    newest: dict[str, tuple[DriveSetpoint, float]] = {}
    for source, setpoint, later_s in said:
        now_s += later_s
        newest[source] = (setpoint, now_s)
        driving = sources.hear(source, setpoint, now_s)
        assert RANKED.index(driving.source) <= RANKED.index(source)
    now_s += after_s
    young = [name for name in RANKED if name in newest and now_s - newest[name][1] < max_age_s]
    order = sources.driving(now_s)
    if not young:
        assert order is None
    else:
        assert order is not None
        assert (order.source, order.setpoint) == (young[0], newest[young[0]][0])


@given(heard)
def test_without_an_age_an_ignored_command_never_drives(
    said: list[tuple[str, DriveSetpoint, float]],
) -> None:
    sources, now_s, ignored = Sources(RANKED, 0.0), 0.0, set()
    for number, (source, setpoint, _) in enumerate(said):
        now_s = float(number)
        if sources.hear(source, setpoint, now_s).heard_s != now_s:
            ignored.add(now_s)
        order = sources.driving(now_s)
        assert order is not None
        assert order.heard_s not in ignored


def test_a_person_who_is_gone_holds_nothing_even_where_nothing_grows_old() -> None:
    sources = Sources(RANKED, 0.0, {KEYS})
    sources.hear(WORDS, FAST, 0.0)
    assert sources.hear(KEYS, SLOW, 100.0).source == KEYS
    assert driver(sources, 100.0 + HELD_AGE_S - 0.01) == KEYS
    assert driver(sources, 100.0 + HELD_AGE_S) == "", "nor does what was said before revive"
    assert sources.hear(WORDS, FAST, 101.0).source == WORDS
    assert driver(sources, 1e6) == WORDS
    assert Sources(RANKED, 9.0, {KEYS}).limit_s(KEYS) == HELD_AGE_S
    assert Sources(RANKED, 0.1, {KEYS}).limit_s(KEYS) == 0.1
