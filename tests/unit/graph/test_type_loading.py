"""Two observers in one process load the same type: neither finds it half loaded."""

from __future__ import annotations

import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from types import ModuleType
from typing import Any

import pytest

from graph.messages.types import load_message, load_service

LOADED_WITHIN_S = 5.0


class HalfLoaded(type):
    """Has its own type support at once, and that of what is inside it only later."""

    _TYPE_SUPPORT: object = None
    inner: object = None
    begun = threading.Event()
    other_looks = threading.Event()

    def __import_type_support__(cls) -> None:
        HalfLoaded._TYPE_SUPPORT = object()
        HalfLoaded.begun.set()
        # Long enough for the other thread to take what is there; with a lock it cannot.
        HalfLoaded.other_looks.wait(0.3)
        HalfLoaded.inner = object()


class Thing(metaclass=HalfLoaded):
    """A generated type, as far as loading goes."""


def test_a_type_that_another_thread_is_loading_is_waited_for(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    package: Any = ModuleType("half_msgs")
    for kind in ("msg", "srv"):
        module: Any = ModuleType(f"half_msgs.{kind}")
        module.Thing = Thing
        monkeypatch.setitem(sys.modules, f"half_msgs.{kind}", module)
    monkeypatch.setitem(sys.modules, "half_msgs", package)

    def second() -> object:
        assert HalfLoaded.begun.wait(LOADED_WITHIN_S)
        found: Any = load_service("half_msgs/srv/Thing")
        HalfLoaded.other_looks.set()
        return found.inner

    with ThreadPoolExecutor(2) as pool:
        inner = pool.submit(second)
        pool.submit(load_message, "half_msgs/msg/Thing").result(LOADED_WITHIN_S)
        assert inner.result(LOADED_WITHIN_S) is not None
