"""What the base of the nodes does for itself is no node's to change by the chance of a name."""

from __future__ import annotations

import importlib

import pytest

from nodes.parts.node import LessonNode
from tests.ros.peer import ROOT

MODULES = sorted(path.stem for path in (ROOT / "nodes").glob("[!_]*.py"))


def private(kind: type) -> set[str]:
    return {name for name in vars(kind) if name.startswith("_") and not name.endswith("__")}


@pytest.mark.parametrize("module", MODULES)
def test_no_private_name_of_a_node_hides_one_of_its_base(module: str) -> None:
    kinds = [
        item
        for item in vars(importlib.import_module(f"nodes.{module}")).values()
        if isinstance(item, type) and issubclass(item, LessonNode) and item is not LessonNode
    ]
    for kind in kinds:
        of_base = set().union(*map(private, kind.__mro__[1:]))
        assert not private(kind) & of_base, kind
