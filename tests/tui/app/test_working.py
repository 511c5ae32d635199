"""What a worker comes back to when its widget is being taken away."""

from __future__ import annotations

import importlib
import inspect
import pkgutil
from types import FunctionType

from textual.app import App
from textual.dom import DOMNode

import tui
import tui.widgets
from tui.widgets.working import Working


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
