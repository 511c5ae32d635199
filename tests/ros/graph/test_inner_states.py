"""Lifecycles, log levels and components of real nodes, as an observer sees and changes them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import pytest
from lifecycle_msgs.srv import ChangeState

from graph.observer import requests
from tests.ros.managed_nodes import NAMES, started
from tests.ros.observing import Watcher
from tests.ros.peer import Peer
from tests.waiting import wait_until

if TYPE_CHECKING:
    import subprocess

    from graph.inner_states import LifecycleRow

pytestmark = pytest.mark.nightly

PATIENT_S = 30


@pytest.fixture(scope="module")
def nodes(module_domain: int) -> Iterator[subprocess.Popen[bytes]]:
    with started(module_domain) as process:
        yield process


@pytest.fixture(scope="module")
def watcher(module_domain: int, nodes: subprocess.Popen[bytes]) -> Iterator[Watcher]:
    del nodes
    watcher = Watcher(module_domain)
    watcher.want(inner_states=True)
    wait_until(
        lambda: {row.node for row in watcher.update.lifecycles if row.state} == whole(NAMES), "the states of all"
    )
    yield watcher
    watcher.close()


def whole(names: tuple[str, ...]) -> set[str]:
    return {f"/{name}" for name in names}


def row(watcher: Watcher, name: str) -> LifecycleRow:
    return next(row for row in watcher.update.lifecycles if row.node == f"/{name}")


def until_it_is(watcher: Watcher, name: str, state: str, *transitions: str) -> None:
    wait_until(
        lambda: (row(watcher, name).state, row(watcher, name).transitions) == (state, transitions),
        f"{name} to be {state} with {transitions}, not {row(watcher, name)}",
    )


def change(watcher: Watcher, name: str, transition: str) -> tuple[str, str]:
    """The state that it led to, and why it was not made."""
    result = watcher.observer.ask(requests.ChangeState(f"/{name}", transition)).result(PATIENT_S)
    assert (result.node, result.transition) == (f"/{name}", transition)
    return result.state, result.error


def test_a_node_goes_through_its_states(watcher: Watcher) -> None:
    until_it_is(watcher, "good", "unconfigured", "configure", "shutdown")
    assert change(watcher, "good", "configure") == ("inactive", "")
    until_it_is(watcher, "good", "inactive", "cleanup", "activate", "shutdown")
    assert change(watcher, "good", "activate") == ("active", "")
    until_it_is(watcher, "good", "active", "deactivate", "shutdown")
    assert change(watcher, "good", "configure") == (
        "active",
        "/good is active: configure is not possible there, only deactivate, shutdown",
    )
    assert change(watcher, "good", "deactivate") == ("inactive", "")
    assert change(watcher, "good", "cleanup") == ("unconfigured", "")


def test_a_transition_by_somebody_else_is_seen_though_nobody_asks(
    watcher: Watcher, module_domain: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("graph.calls.lifecycle.ASK_AGAIN_S", 1000.0)
    until_it_is(watcher, "good", "unconfigured", "configure", "shutdown")
    with Peer(module_domain, "somebody") as peer:
        request = ChangeState.Request()
        request.transition.label = "configure"
        assert peer.ask("/good/change_state", ChangeState, request).success
        until_it_is(watcher, "good", "inactive", "cleanup", "activate", "shutdown")
        request.transition.label = "cleanup"
        assert peer.ask("/good/change_state", ChangeState, request).success
        until_it_is(watcher, "good", "unconfigured", "configure", "shutdown")


def test_a_refusal_is_told_by_where_it_led(watcher: Watcher) -> None:
    state, error = change(watcher, "refusing", "configure")
    assert state == "unconfigured"
    assert "/refusing" in error


def test_a_log_level_is_read_and_set(watcher: Watcher) -> None:
    ask = watcher.observer.ask
    assert ask(requests.LogLevel("/good")).result(PATIENT_S).level == "info"
    for level in ("debug", "info", "warn", "error", "fatal"):
        result = ask(requests.LogLevel("/good", level)).result(PATIENT_S)
        assert (result.level, result.error) == (level, "")
    assert ask(requests.LogLevel("good")).result(PATIENT_S).level == "fatal"
    assert ask(requests.LogLevel("/refusing")).result(PATIENT_S).level == "info"
