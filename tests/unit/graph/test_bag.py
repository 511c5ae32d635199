"""Bags that are no bags, cut short, or foreign: each gets a word that names file and fix."""

from __future__ import annotations

import errno
import os
from io import BytesIO
from pathlib import Path

import pytest
from mcap.reader import make_reader

from graph.bag.errors import BagError, unreadable
from graph.bag.reading import open_bag
from tests.unit.bags import write_bag
from text.i18n import localized, set_language


@pytest.fixture(scope="module")
def long_bag(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """A file of several chunks, with 100 003 messages."""
    folder = tmp_path_factory.mktemp("long") / "walk"
    return (write_bag(folder, seconds=5000, hz=20) / "walk.mcap").read_bytes()


def said_of(path: Path) -> str:
    with pytest.raises(BagError) as told:
        open_bag(path)
    return str(told.value)


def test_a_bag_tells_its_topics_and_times(tmp_path: Path) -> None:
    with open_bag(write_bag(tmp_path / "walk")) as bag:
        assert [(each.name, each.messages) for each in bag.topics] == [
            ("/battery", 1),
            ("/map_name", 1),
            ("/number", 101),
        ]
        assert (bag.name, bag.length_s, bag.messages_count, bag.notes) == ("walk", 10.0, 103, ())


@pytest.mark.parametrize("which", ["walk", "walk/metadata.yaml", "walk/walk.mcap"])
def test_a_bag_is_opened_by_its_folder_or_its_files(tmp_path: Path, which: str) -> None:
    write_bag(tmp_path / "walk")
    with open_bag(tmp_path / which) as bag:
        assert len(list(bag.messages())) == 103


def test_a_folder_without_metadata_is_opened_by_its_file(tmp_path: Path) -> None:
    (write_bag(tmp_path / "walk") / "metadata.yaml").unlink()
    with open_bag(tmp_path / "walk") as bag:
        assert len(list(bag.messages())) == 103


def test_what_is_not_there_is_no_bag(tmp_path: Path) -> None:
    words = said_of(tmp_path / "nothing")
    assert "nothing is not a bag: there is no such file or folder" in words
    assert "metadata.yaml" in words


def test_an_empty_folder_and_another_file_are_no_bags(tmp_path: Path) -> None:
    assert "neither metadata.yaml nor an .mcap file" in said_of(tmp_path)
    text = tmp_path / "letter.txt"
    text.write_text("hello")
    assert "ends neither in .mcap nor in .db3" in said_of(text)


def test_what_is_neither_file_nor_folder_is_no_bag_and_is_not_waited_for(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe.mcap"
    os.mkfifo(pipe)
    for path in (pipe, Path("/dev/null"), Path("/dev/zero")):
        assert f"{path} is not a bag: it is neither a file nor a folder" in said_of(path)


def test_a_link_to_itself_and_an_endless_name_are_told(tmp_path: Path) -> None:
    link = tmp_path / "l.mcap"
    link.symlink_to(link)
    assert "l.mcap is not a bag: there is no such file or folder" in said_of(link)
    assert "cannot be read: File name too long" in said_of(tmp_path / ("n" * 300))


def test_a_reason_that_is_a_sentence_brings_no_second_dot() -> None:
    words = str(unreadable(Path("walk"), ValueError("File magic is invalid.")))
    assert words == "walk cannot be read: it is damaged: File magic is invalid"


@pytest.mark.parametrize("name", ["fake.mcap", "fake.db3"])
def test_an_empty_file_is_told_as_such(tmp_path: Path, name: str) -> None:
    fake = tmp_path / name
    fake.touch()
    assert said_of(fake) == f"{fake} cannot be read: {name} is empty, nothing was written to it"


@pytest.mark.parametrize(("name", "kind"), [("fake.mcap", "MCAP"), ("fake.db3", "SQLite")])
def test_a_file_that_only_looks_like_one_is_named(tmp_path: Path, name: str, kind: str) -> None:
    fake = tmp_path / name
    fake.write_bytes(b"hello, I am no bag")
    assert said_of(fake) == f"{fake} cannot be read: {name} is not an {kind} file"


def test_a_file_that_metadata_names_and_that_is_gone_is_told(tmp_path: Path) -> None:
    bag = write_bag(tmp_path / "walk", seconds=1)
    (bag / "walk.mcap").unlink()
    assert said_of(bag).endswith("metadata.yaml names walk.mcap, which is not there")


def test_what_is_wrong_with_a_file_is_told_in_russian_alone(tmp_path: Path) -> None:
    bag = write_bag(tmp_path / "walk", seconds=1)
    (bag / "walk.mcap").write_bytes(b"")
    with pytest.raises(BagError) as told:
        open_bag(bag)
    set_language("ru")
    try:
        said_in_russian = localized(told.value.words)
    finally:
        set_language("en")
    assert (
        said_in_russian
        == f"{bag} не удаётся прочитать: файл walk.mcap пуст, в него ничего не записано"
    )


def test_what_the_system_says_of_a_file_is_told_in_russian_too() -> None:
    words = unreadable(Path("walk"), OSError(errno.EIO, os.strerror(errno.EIO))).words
    assert words == "walk cannot be read: Input/output error"
    set_language("ru")
    try:
        assert localized(words) == "walk не удаётся прочитать: ошибка ввода-вывода"
    finally:
        set_language("en")


def test_an_unknown_storage_is_named(tmp_path: Path) -> None:
    path = write_bag(tmp_path / "walk") / "metadata.yaml"
    path.write_text(path.read_text().replace("storage_identifier: mcap", "storage_identifier: x9"))
    with open_bag(tmp_path / "walk") as bag:
        assert bag.notes == ("metadata.yaml names the storage x9, walk.mcap is mcap",)
    (tmp_path / "walk" / "walk.mcap").write_bytes(b"of x9")
    words = said_of(tmp_path / "walk")
    assert "storage 'x9' is not known" in words
    assert "where ROS is installed" in words


def test_broken_metadata_are_named(tmp_path: Path) -> None:
    (write_bag(tmp_path / "walk") / "metadata.yaml").write_text("a: [")
    with open_bag(tmp_path / "walk") as bag:
        # The file itself is whole.
        assert len(list(bag.messages())) == 103


@pytest.mark.parametrize("share", [0.2, 0.5, 0.9, 0.99])
def test_a_bag_cut_anywhere_is_read_as_far_as_it_goes(
    tmp_path: Path, long_bag: bytes, share: float
) -> None:
    file = write_bag(tmp_path / "walk") / "walk.mcap"
    file.write_bytes(long_bag[: int(len(long_bag) * share)])
    with open_bag(tmp_path / "walk") as bag:
        found = list(bag.messages())
        stamps = [stamp for _topic, stamp, _raw in found]
        assert 0 < len(found) == bag.messages_count <= 100_003
        assert stamps == sorted(stamps)
        assert "was cut short" in " ".join(bag.notes)
        assert f"{len(found)} messages are intact" in " ".join(bag.notes)


def test_a_bag_cut_in_its_first_breath_is_empty_but_opens(tmp_path: Path) -> None:
    file = write_bag(tmp_path / "walk") / "walk.mcap"
    file.write_bytes(file.read_bytes()[:60])
    with open_bag(tmp_path / "walk") as bag:
        assert bag.messages_count == 0
        assert list(bag.messages()) == []
        assert bag.length_s == 0.0


def damaged(file: Path, long_bag: bytes, share: float = 1.0) -> None:
    """Write the long bag, or its first part, with 2000 wrong bytes at a third of it."""
    wrong = bytearray(long_bag[: int(len(long_bag) * share)])
    middle = len(long_bag) // 3
    wrong[middle : middle + 2000] = b"\xff" * 2000
    file.write_bytes(wrong)


def test_a_damaged_chunk_costs_that_chunk_and_is_told(tmp_path: Path, long_bag: bytes) -> None:
    file = write_bag(tmp_path / "walk") / "walk.mcap"
    damaged(file, long_bag)
    with open_bag(file) as bag:
        assert bag.damage is None
        stamps = [stamp for _topic, stamp, _raw in bag.messages()]
        assert stamps == sorted(stamps)
        assert stamps[-1] == bag.end_ns, "what comes after it is read"
        lost = bag.messages_count - len(stamps)
        assert 0 < lost < bag.messages_count / 2
        list(bag.messages())
        assert f"messages lost: {lost}, damaged places: 1," in str(bag.damage), "counted once"


def test_a_damaged_chunk_of_a_bag_without_an_end_costs_that_chunk(
    tmp_path: Path, long_bag: bytes
) -> None:
    file = write_bag(tmp_path / "walk") / "walk.mcap"
    file.write_bytes(long_bag[: int(len(long_bag) * 0.9)])
    with open_bag(file) as bag:
        whole = len(list(bag.messages()))
    damaged(file, long_bag, 0.9)
    with open_bag(file) as bag:
        found = len(list(bag.messages()))
        assert whole / 2 < found == bag.messages_count < whole
        assert f"messages lost: {whole - found}, damaged places: 1," in str(bag.damage)
        assert "was cut short" in " ".join(bag.notes)


def test_a_chunk_whose_own_head_is_damaged_is_left_out(tmp_path: Path, long_bag: bytes) -> None:
    file = write_bag(tmp_path / "walk") / "walk.mcap"
    summary = make_reader(BytesIO(long_bag)).get_summary()
    assert summary is not None
    place = summary.chunk_indexes[1].chunk_start_offset
    wrong = bytearray(long_bag)
    wrong[place : place + 40] = bytes(40)
    file.write_bytes(wrong)
    with open_bag(file) as bag:
        found = len(list(bag.messages()))
        assert f"messages lost: {bag.messages_count - found}," in str(bag.damage)


def test_a_bag_of_which_the_first_chunk_is_damaged_names_what_nobody_can_name(
    tmp_path: Path, long_bag: bytes
) -> None:
    file = write_bag(tmp_path / "walk") / "walk.mcap"
    wrong = bytearray(long_bag[: int(len(long_bag) * 0.9)])
    wrong[3000:5000] = bytes(2000)
    file.write_bytes(wrong)
    with open_bag(file) as bag:
        assert bag.messages_count == len(list(bag.messages()))
        assert "is damaged: messages lost: " in str(bag.damage)


def test_several_files_of_one_bag_are_read_though_the_last_is_cut(
    tmp_path: Path, long_bag: bytes
) -> None:
    folder = write_bag(tmp_path / "walk", seconds=1)
    (folder / "walk_1.mcap").write_bytes(long_bag[: len(long_bag) // 2])
    (folder / "metadata.yaml").unlink()
    with open_bag(folder) as bag:
        assert len(list(bag.messages())) == bag.messages_count > 13
        assert bag.is_cut
        assert bag.is_incomplete
