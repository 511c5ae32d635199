"""Modules imported ahead are those that a node would import itself, edits included."""

from __future__ import annotations

import importlib
import importlib.util
import os
import sys
from typing import TYPE_CHECKING

import pytest

from launcher.spawn_server.shared_modules import SharedModules

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

PACKAGE = "some_lesson_nodes"


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    folder = tmp_path / PACKAGE
    folder.mkdir()
    (folder / "__init__.py").write_text("__preload__ = ('_shared', '_broken')\nRUNS = []\n")
    (folder / "_shared.py").write_text("VALUE = 'before'\n")
    (folder / "_broken.py").write_text("raise RuntimeError\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    yield folder
    for name in [name for name in sys.modules if name.startswith(PACKAGE)]:
        del sys.modules[name]


def value() -> str:
    return str(importlib.import_module(f"{PACKAGE}._shared").VALUE)


@pytest.mark.usefixtures("package")
def test_what_is_as_it_was_is_kept() -> None:
    shared = SharedModules()
    assert list(shared.load(PACKAGE)) == ["_shared"]
    loaded = sys.modules[f"{PACKAGE}._shared"]
    shared.renew(f"{PACKAGE}.node")
    assert sys.modules[f"{PACKAGE}._shared"] is loaded
    assert sys.modules[PACKAGE]._shared is loaded


def test_what_was_edited_is_imported_anew(package: Path) -> None:
    shared = SharedModules()
    list(shared.load(PACKAGE))
    (package / "_shared.py").write_text("VALUE = 'afterwards'\n")
    importlib.invalidate_caches()
    shared.renew(f"{PACKAGE}.node")
    assert value() == "afterwards"


def test_an_edit_of_the_same_length_is_seen_by_its_time(package: Path) -> None:
    shared = SharedModules()
    list(shared.load(PACKAGE))
    (package / "_shared.py").write_text("VALUE = 'behind'\n")
    os.utime(package / "_shared.py", ns=(1, 1))
    importlib.invalidate_caches()
    shared.renew(f"{PACKAGE}.node")
    assert value() == "behind"


@pytest.mark.usefixtures("package")
def test_a_node_whose_path_leads_elsewhere_gets_what_is_there(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    shared = SharedModules()
    list(shared.load(PACKAGE))
    mine = tmp_path / "mine" / PACKAGE
    mine.mkdir(parents=True)
    (mine / "__init__.py").write_text("")
    (mine / "_shared.py").write_text("VALUE = 'mine'\n")
    monkeypatch.syspath_prepend(str(tmp_path / "mine"))
    shared.renew(f"{PACKAGE}.node")
    assert value() == "mine"


def test_a_package_that_is_not_there_is_no_trouble() -> None:
    shared = SharedModules()
    assert list(shared.load("no_such_package_of_nodes")) == []
    shared.renew(f"{PACKAGE}.node")


def test_what_only_some_nodes_need_is_imported_idly_and_its_edits_are_seen(package: Path) -> None:
    (package / "__init__.py").write_text(
        "__preload__ = ('_shared',)\n__preload_idle__ = ('_rare',)\n"
    )
    (package / "_rare.py").write_text("VALUE = 'before'\n")
    shared = SharedModules()
    assert list(shared.load(PACKAGE)) == ["_shared"]
    assert f"{PACKAGE}._rare" not in sys.modules
    assert list(shared.load_idly(PACKAGE)) == ["_rare"]
    (package / "_rare.py").write_text("VALUE = 'afterwards'\n")
    importlib.invalidate_caches()
    shared.renew(f"{PACKAGE}.node")
    assert importlib.import_module(f"{PACKAGE}._rare").VALUE == "afterwards"
    assert value() == "before"


def test_the_lesson_nodes_name_modules_that_there_are() -> None:
    nodes = importlib.import_module("nodes")
    named = (*nodes.__preload__, *nodes.__preload_idle__)
    missing = [name for name in named if importlib.util.find_spec(f"nodes.{name}") is None]
    assert missing == []
