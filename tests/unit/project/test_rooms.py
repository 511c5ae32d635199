"""How the rooms are furnished: no circle of imports, and no class in pieces."""

from __future__ import annotations

import ast
from collections import defaultdict
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import grimp

from tests.rooms import ROOMS

ROOT = Path(__file__).parents[3]


def classes() -> list[tuple[Path, ast.ClassDef]]:
    """Return each class of the rooms with its file."""
    return [
        (path, node)
        for room in ROOMS
        for path in sorted((ROOT / room).rglob("*.py"))
        for node in ast.walk(ast.parse(path.read_text()))
        if isinstance(node, ast.ClassDef)
    ]


def test_no_module_needs_itself_by_way_of_others() -> None:
    """Imports for type checkers, and those within functions, count as well."""
    graph = grimp.build_graph(*ROOMS, cache_dir=None)
    needs = {module: graph.find_modules_directly_imported_by(module) for module in graph.modules}
    try:
        TopologicalSorter(needs).prepare()
    except CycleError as error:
        circle: list[str] = error.args[1]
    else:
        circle = []
    assert circle == []


def test_no_class_is_split_over_files_by_inheritance() -> None:
    """A base class with one subclass, in another file, is half of that class."""
    homes = {node.name: path for path, node in classes()}
    subclasses = defaultdict(list)
    for path, node in classes():
        for base in node.bases:
            name = base.value if isinstance(base, ast.Subscript) else base
            if isinstance(name, ast.Name) and name.id in homes:
                subclasses[name.id].append((node.name, path))
    halves = {
        name: found[0][0]
        for name, found in subclasses.items()
        if len(found) == 1 and found[0][1] != homes[name]
    }
    assert halves == {}
