"""ARCHITECTURE.md and CONTRIBUTING.md say what the code is: the picture, each name, each file."""

from __future__ import annotations

import ast
import re

import pytest

from tests.rooms import ROOMS
from tests.unit.scripts_of_setup import ROOT, load

architecture = load("architecture")
PAGES = ("ARCHITECTURE.md", "CONTRIBUTING.md")
EXAMPLES = re.compile(r"thermometer|notes")
"""In the names of what a reader of CONTRIBUTING.md is told to make."""
NAME = re.compile(rf"`((?:{'|'.join(ROOMS)})(?:\.\w+)+)`")
FILE = re.compile(r"`([\w.-]+/[\w./-]*)`|\b((?:scripts|tests|docs|profiles)/[\w./-]+\.\w+)")


def test_the_picture_is_that_of_the_code() -> None:
    text = (ROOT / "ARCHITECTURE.md").read_text()
    assert text == architecture.page(text), "run: make architecture"


def _defined(body: list[ast.stmt], name: str) -> list[ast.stmt] | None:
    """Return the body of what is defined under a name; None if nothing is."""
    for statement in body:
        if isinstance(statement, ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
            if statement.name == name:
                return statement.body
        elif isinstance(statement, ast.Assign | ast.AnnAssign):
            targets = statement.targets if isinstance(statement, ast.Assign) else [statement.target]
            if any(isinstance(target, ast.Name) and target.id == name for target in targets):
                return []
    return None


def exists(name: str) -> bool:
    """Whether there is a module, or something defined in one, of that name."""
    path, parts = ROOT, name.split(".")
    while parts and (path / parts[0]).is_dir():
        path /= parts.pop(0)
    if parts and (path / f"{parts[0]}.py").exists():
        path /= f"{parts.pop(0)}.py"
    else:
        path /= "__init__.py"
    body: list[ast.stmt] | None = ast.parse(path.read_text()).body
    for part in parts:
        body = _defined(body or [], part)
    return body is not None


@pytest.mark.parametrize("page", PAGES)
def test_every_name_on_the_page_is_one_in_the_code(page: str) -> None:
    names = set(NAME.findall((ROOT / page).read_text()))
    assert names
    assert {name for name in names if not exists(name) and not EXAMPLES.search(name)} == set()


@pytest.mark.parametrize("page", PAGES)
def test_every_file_on_the_page_is_there(page: str) -> None:
    found = {name or other for name, other in FILE.findall((ROOT / page).read_text())}
    files = {name for name in found if not EXAMPLES.search(name)}
    assert files
    assert {name for name in files if not (ROOT / name).exists()} == set()


@pytest.mark.parametrize("name", ["graph.nothing", "graph.data.Nothing", "tui.app.DeckApp.nothing"])
def test_what_is_not_there_is_found_out(name: str) -> None:
    assert not exists(name)
