"""What a worker comes back to when its widget is being taken away."""

from __future__ import annotations

import asyncio
import importlib
import inspect
import pkgutil
import threading
from types import FunctionType

from textual.app import App, ComposeResult
from textual.dom import DOMNode
from textual.widget import Widget
from textual.widgets import Static

import tui
import tui.widgets
from tests.waiting import until
from tui.widgets.working import Working

TIMEOUT_S = 20.0


class Lingering(Static):
    """A child that takes its time to go."""

    def __init__(self, goes_on: asyncio.Event) -> None:
        super().__init__()
        self._goes_on = goes_on

    async def on_unmount(self) -> None:
        await asyncio.wait_for(self._goes_on.wait(), TIMEOUT_S)


class Loader(Widget, Working):
    """Puts what it loaded into its child."""

    def __init__(self, goes_on: asyncio.Event) -> None:
        super().__init__()
        self.loaded = threading.Event()
        self._goes_on = goes_on

    def compose(self) -> ComposeResult:
        yield Static("nothing yet", id="words")
        yield Lingering(self._goes_on)

    def on_mount(self) -> None:
        self.run_worker(self._load())

    async def _load(self) -> None:
        await asyncio.to_thread(self.loaded.wait, TIMEOUT_S)
        self.query_one("#words", Static).update("loaded")


class OneLoader(App[None]):
    """A loader, to be taken away."""

    def __init__(self) -> None:
        super().__init__()
        self.goes_on = asyncio.Event()

    def compose(self) -> ComposeResult:
        yield Loader(self.goes_on)


async def test_what_is_loaded_while_its_widget_goes_ends_nothing() -> None:
    app = OneLoader()
    async with app.run_test():
        loader = app.query_one(Loader)
        worker = next(iter(app.workers))
        loader.remove()
        await until(lambda: not loader.query("#words"), "the child gone")
        loader.loaded.set()
        await until(lambda: worker.is_finished, "the end of its work")
        app.goes_on.set()
        await until(lambda: not loader.is_attached, "the widget gone")
        assert worker.error is None or worker.is_cancelled


def own_work(cls: type) -> bool:
    """Whether the class itself starts workers."""
    functions = [value for value in vars(cls).values() if isinstance(value, FunctionType)]
    return any("run_worker" in function.__code__.co_names for function in functions)


def test_whatever_has_workers_gives_them_up_when_it_goes() -> None:
    found = set()
    for module in pkgutil.walk_packages(tui.__path__, "tui."):
        if module.name.endswith(".__main__"):
            continue
        for _, cls in inspect.getmembers(importlib.import_module(module.name), inspect.isclass):
            ours = cls.__module__ == module.name and issubclass(cls, DOMNode)
            if ours and own_work(cls) and not issubclass(cls, App):
                found.add(cls)
    assert len(found) >= 10
    assert [cls.__name__ for cls in found if not issubclass(cls, Working)] == []
