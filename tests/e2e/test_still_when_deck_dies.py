"""Whatever becomes of Deck itself, the wheels stand, as the emulated motors tell.

The emulated robot belongs to nobody here: it goes on as a real one would.
"""

from __future__ import annotations

import json
import os
import signal
from typing import TYPE_CHECKING

import pytest

from tests.e2e import marked
from tests.ros.devices import mock_robot
from tests.ros.peer import Peer
from tests.ros.wheels import Wheels
from tests.waiting import wait_until

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from tests.e2e.conftest import Deck
    from tests.e2e.terminal import Terminal


@pytest.fixture(scope="module")
def devices(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("still") / "devices"


@pytest.fixture(scope="module")
def module_wheels(module_domain: int, devices: Path) -> Iterator[Wheels]:
    with mock_robot(module_domain, devices) as robot, Peer(module_domain) as peer:
        robot.wait_for_words("The simulated robot is in")
        yield Wheels(peer)


@pytest.fixture
def wheels(module_wheels: Wheels) -> Iterator[Wheels]:
    yield module_wheels
    module_wheels.quiet()


@pytest.fixture
def profile(tmp_path: Path, devices: Path, module_domain: int) -> str:
    nodes = {
        "chassis": {"run": "nodes.chassis", "params": {"port": str(devices / "pico")}},
        "differential": {"run": "nodes.electronic_differential", "params": {"max_age_s": 0.5}},
    }
    path = tmp_path / "wheels.yaml"
    document = {"title": {"en": "Two wheels"}, "domain": module_domain, "nodes": nodes}
    path.write_text(json.dumps(document), encoding="utf-8")
    return str(path)


def driving(deck: Deck, wheels: Wheels, *arguments: str) -> Terminal:
    terminal = deck.open(*arguments)
    wheels.drive()
    wheels.wait_moving()
    return terminal


def supervisor(deck: Deck) -> int:
    (pid,) = (pid for pid, line in marked.alive(deck.mark).items() if "-m launcher.sup" in line)
    return pid


def assert_stopped_for_good(deck: Deck, wheels: Wheels) -> None:
    # First: while there are nodes, a stand may be a pause of somebody who has little time.
    wait_until(lambda: not marked.nodes(deck.mark), "the end of every node")
    wheels.assert_stands()
    wait_until(lambda: not marked.alive(deck.mark), "every process gone")


@pytest.mark.parametrize("way", ["run", "up"])
def test_the_supervisor_is_killed(deck: Deck, wheels: Wheels, profile: str, way: str) -> None:
    driving(deck, wheels, way, profile)
    os.kill(supervisor(deck), signal.SIGKILL)
    assert_stopped_for_good(deck, wheels)


def test_the_screen_is_killed(deck: Deck, wheels: Wheels, profile: str) -> None:
    terminal = driving(deck, wheels, profile)
    terminal.process.kill()
    assert_stopped_for_good(deck, wheels)


def test_the_terminal_is_closed(deck: Deck, wheels: Wheels, profile: str) -> None:
    terminal = driving(deck, wheels, profile)
    terminal.hang_up()
    assert_stopped_for_good(deck, wheels)


def test_deck_ends_while_it_drives(deck: Deck, wheels: Wheels, profile: str) -> None:
    terminal = driving(deck, wheels, profile)
    terminal.press("ctrl+q")
    assert_stopped_for_good(deck, wheels)
