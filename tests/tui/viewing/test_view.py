"""The viewer from the screen: the key, the dialog, what is copied, the end with the session."""

from __future__ import annotations

from typing import Any

import pytest
from textual.pilot import Pilot

from tests.tui.snapshots import opened
from tests.waiting import until
from tui.app import DeckApp
from tui.viewing import view as viewing
from tui.viewing.dialog import ViewDialog
from tui.viewing.process import NotOpenedError, OpenedView

PAGE = OpenedView("http://127.0.0.1:9090", (9090, 9876))
TUNNEL = "ssh -N -L 9090:127.0.0.1:9090 -L 9876:127.0.0.1:9876 pi@192.168.1.20"


class Opened:
    """Stands in for the process, which the tests with ROS start."""

    def __init__(self, where: OpenedView) -> None:
        self.opened = where
        self.ended = False
        self.words = ""

    async def fault(self) -> str:
        return self.words

    async def end(self) -> None:
        self.ended = True


class Starter:
    """Opens what it is told to."""

    def __init__(self) -> None:
        self.where = PAGE
        self.refusal = ""
        self.made: list[Opened] = []

    async def start(self, domain: int) -> Opened:
        del domain
        if self.refusal:
            raise NotOpenedError(self.refusal)
        self.made.append(Opened(self.where))
        return self.made[-1]


@pytest.fixture
def starter(monkeypatch: pytest.MonkeyPatch) -> Starter:
    starter = Starter()
    monkeypatch.setattr(viewing, "start_view", starter.start)
    monkeypatch.setattr(viewing, "LOOK_S", 0.02)
    return starter


async def open_view(app: DeckApp, pilot: Pilot[Any]) -> None:
    await pilot.press("alt+w")
    await until(lambda: isinstance(app.screen, ViewDialog), "the dialog")
    await pilot.pause()


async def test_address_and_tunnel_are_copied(starter: Starter) -> None:
    starter.where = OpenedView(PAGE.url, PAGE.ports, TUNNEL)
    async with opened() as (app, pilot):
        await open_view(app, pilot)
        await pilot.press("y")
        await until(lambda: app.clipboard == PAGE.url, "the address")
        await pilot.press("ctrl+y")
        await until(lambda: app.clipboard == f"{TUNNEL}\n{PAGE.url}", "both")


async def test_it_is_opened_once_ends_by_a_key_and_can_be_opened_again(starter: Starter) -> None:
    async with opened() as (app, pilot):
        await open_view(app, pilot)
        await pilot.press("escape")
        await open_view(app, pilot)
        assert len(starter.made) == 1
        await pilot.press("x")
        await until(lambda: starter.made[0].ended, "its end")
        await open_view(app, pilot)
        assert len(starter.made) == 2


async def test_what_is_missing_is_said_and_the_next_key_tries_again(starter: Starter) -> None:
    starter.refusal = "Rerun is not installed; to install it: make view"
    async with opened() as (app, pilot):
        await pilot.press("alt+w")
        await until(lambda: any(starter.refusal in one.message for one in app._notifications), "the words")
        starter.refusal = ""
        await open_view(app, pilot)
