"""A folder's list of bags marks those that hold fewer messages than their metadata count."""

from __future__ import annotations

import os
import sqlite3
from pathlib import Path

import pytest

from graph.bag.listing import ListedBag, bags_in
from tests.unit.odd_bags import put, write_mcap, write_metadata, write_sqlite
from text.i18n import localized

FEWER = "metadata.yaml counts 40 messages, the files hold 20"


def only(folder: Path) -> ListedBag:
    (bag,) = bags_in(folder)
    return bag


def bag_of(folder: Path, ending: str, **facts: object) -> Path:
    storage = "mcap" if ending == "mcap" else "sqlite3"
    write = write_mcap if ending == "mcap" else write_sqlite
    write(folder / f"walk_0.{ending}")
    return write_metadata(folder, [f"walk_0.{ending}"], storage_identifier=storage, **facts)  # type: ignore[arg-type]


@pytest.mark.parametrize("ending", ["mcap", "db3"])
def test_fewer_messages_than_counted_are_told_with_what_is_there(
    ending: str, tmp_path: Path
) -> None:
    bag_of(tmp_path / "walk", ending, count=40)
    bag = only(tmp_path)
    assert localized(bag.trouble, "en") == FEWER
    assert (bag.messages, bag.topics) == (20, 1)


@pytest.mark.parametrize("ending", ["mcap", "db3"])
def test_as_many_as_counted_are_whole(ending: str, tmp_path: Path) -> None:
    bag_of(tmp_path / "walk", ending)
    assert (only(tmp_path).trouble, only(tmp_path).messages) == ("", 20)


def test_more_than_counted_lose_nothing(tmp_path: Path) -> None:
    bag_of(tmp_path / "walk", "mcap", count=10)
    assert (only(tmp_path).trouble, only(tmp_path).messages) == ("", 10)


def test_what_only_reading_would_tell_is_not_claimed(tmp_path: Path) -> None:
    """A file without statistics, one that is packed, and one that is being written."""
    write_mcap(tmp_path / "a" / "a_0.mcap", statistics=False)
    write_metadata(tmp_path / "a", ["a_0.mcap"], 40)
    bag_of(tmp_path / "b", "mcap", count=40, compression_mode="file", compression_format="zstd")
    folder = bag_of(tmp_path / "c", "db3", count=40)
    with sqlite3.connect(folder / "walk_0.db3") as base:
        base.execute("PRAGMA journal_mode = WAL")
        put(base, 20, 20)
        base.commit()
        assert os.path.getsize(folder / "walk_0.db3-wal")  # noqa: PTH202
        assert [(bag.trouble, bag.messages) for bag in bags_in(tmp_path)] == [("", 40)] * 3
    base.close()
