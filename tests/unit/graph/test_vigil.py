"""Whether the observer hangs, whom it does not see, and how it is found."""

from __future__ import annotations

import pytest

from graph.observer.census import Census
from graph.observer.doubt import LOOKS_FOR_S, SURE_S, SecondLook
from graph.observer.vigil import GIVEN_UP_AFTER_S, HUNG_AFTER_S, LOOK_S, OLD_AFTER_S, Vigil
from graph.ros import FAST_DDS, FAST_DDS_VARIABLES, RMW, announcing
from launcher.domain.discovery import settings_of_discovery
from tests.conftest import MIDDLEWARE


def idle() -> bool:
    return False


def busy() -> bool:
    return True


def looked_at(vigil: Vigil, from_s: float, to_s: float, ready: bool) -> float | None:
    """Look all the time; return when it is said to hang."""
    now_s = from_s
    while now_s <= to_s:
        if vigil.hangs(now_s, busy if ready else idle):
            return now_s
        now_s += LOOK_S
    return None


def test_what_is_known_is_old_once_no_sign_has_come_for_a_while() -> None:
    vigil = Vigil(0.0)
    vigil.sign(10.0)
    assert vigil.old_since_s(10.0 + OLD_AFTER_S) is None
    assert vigil.old_since_s(10.1 + OLD_AFTER_S) == 10.0
    vigil.sign(20.0)
    assert vigil.old_since_s(20.1) is None


def test_one_that_could_run_and_does_not_hangs() -> None:
    ended_s = looked_at(Vigil(0.0), 0.0, 100.0, ready=False)
    assert ended_s is not None
    assert HUNG_AFTER_S < ended_s <= HUNG_AFTER_S + 2 * LOOK_S


def test_one_that_only_lacks_a_processor_does_not_hang_for_a_minute() -> None:
    ended_s = looked_at(Vigil(0.0), 0.0, 100.0, ready=True)
    assert ended_s is not None
    assert ended_s > GIVEN_UP_AFTER_S


ROBOT, SCREEN = b"robot", b"screen"


def test_only_one_that_surely_sees_more_takes_over() -> None:
    less, more, other = (Census(frozenset(known)) for known in ([ROBOT], [ROBOT, SCREEN], [SCREEN]))
    look = SecondLook(0.0)
    assert not look.sees_more(less, less, 1.0)
    assert not look.sees_more(less, more, 2.0)
    # The first has found it in the meantime.
    assert not look.sees_more(more, more, 3.0)
    assert not look.sees_more(less, more, 4.0)
    assert not look.sees_more(less, other, 5.0)
    assert not look.sees_more(less, more, 6.0)
    assert look.sees_more(less, more, 6.0 + SURE_S)
    assert not look.is_over(LOOKS_FOR_S - 1.0)
    assert look.is_over(LOOKS_FOR_S)


@pytest.fixture
def nothing_chosen(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in MIDDLEWARE:
        monkeypatch.delenv(name, raising=False)


@pytest.mark.usefixtures("nothing_chosen")
@pytest.mark.parametrize("discovery", ["localhost", "subnet", ("192.0.2.7",)])
@pytest.mark.parametrize("environ", [{}, {FAST_DDS_VARIABLES[0]: str(FAST_DDS)}, {RMW: "rmw_cyclonedds_cpp"}])
def test_it_is_found_as_the_nodes_of_a_session_are(
    discovery: str | tuple[str, ...], environ: dict[str, str], monkeypatch: pytest.MonkeyPatch
) -> None:
    for name, value in environ.items():
        monkeypatch.setenv(name, value)
    assert announcing(discovery) == settings_of_discovery(environ, discovery)
