"""How the rooms are furnished: no circle of imports, no crowded folder, no name for two classes."""

from __future__ import annotations

import ast
from collections import Counter, defaultdict
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import grimp

from tests.rooms import ROOMS

ROOT = Path(__file__).parents[3]
FLAT = 30
"""How many modules one sees at a glance."""


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


def test_no_folder_is_crowded() -> None:
    folders = (*ROOMS, "bench", "scripts", "tests")
    files = Counter(path.parent for room in folders for path in (ROOT / room).rglob("*.py"))
    assert {str(path): count for path, count in files.items() if count > FLAT} == {}


def test_no_two_classes_have_one_name() -> None:
    homes = defaultdict(list)
    for path, node in classes():
        homes[node.name].append(str(path.relative_to(ROOT)))
    assert {name: places for name, places in homes.items() if len(places) > 1} == {}


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
