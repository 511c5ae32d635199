"""Bags, whole, odd and damaged: what is there is read, what is missing is counted."""

from __future__ import annotations

import sqlite3
from contextlib import closing
from pathlib import Path

import pytest
from mcap.writer import CompressionType, IndexType

from graph.bag.errors import BagError
from graph.bag.listing import ListedBag, bags_in
from graph.bag.reading import Bag, open_bag
from graph.data import Interest
from graph.replay.player import ReplayTopics
from tests.unit.bags import write_bag
from tests.unit.odd_bags import TEXT, TOPIC, damage_chunk, times, write_mcap, write_metadata, write_sqlite
from text.i18n import localized


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


def test_an_empty_folder_and_another_file_are_no_bags(tmp_path: Path) -> None:
    assert "neither metadata.yaml nor an .mcap file" in said_of(tmp_path)
    text = tmp_path / "letter.txt"
    text.write_text("hello")
    assert "ends neither in .mcap nor in .db3" in said_of(text)


@pytest.mark.parametrize("share", [0.2, 0.5, 0.9, 0.99])
def test_a_bag_cut_anywhere_is_read_as_far_as_it_goes(tmp_path: Path, long_bag: bytes, share: float) -> None:
    file = write_bag(tmp_path / "walk") / "walk.mcap"
    file.write_bytes(long_bag[: int(len(long_bag) * share)])
    with open_bag(tmp_path / "walk") as bag:
        found = list(bag.messages())
        stamps = [stamp for _topic, stamp, _raw in found]
        assert 0 < len(found) == bag.messages_count <= 100_003
        assert stamps == sorted(stamps)
        assert "was cut short" in " ".join(bag.notes)
        assert f"{len(found)} messages are intact" in " ".join(bag.notes)


def test_a_file_with_a_damaged_place_is_read_up_to_there_and_the_rest_is_counted(
    tmp_path: Path, long_bag: bytes
) -> None:
    file = write_bag(tmp_path / "walk") / "walk.mcap"
    middle = len(long_bag) // 3
    file.write_bytes(long_bag[:middle] + b"\xff" * 2000 + long_bag[middle + 2000 :])
    with open_bag(file) as bag:
        assert bag.damage is None
        stamps = [stamp for _topic, stamp, _raw in bag.messages()]
        assert stamps == sorted(stamps)
        assert 0 < len(stamps) < bag.messages_count == 100_003
        assert f"of 100003 messages only {len(stamps)} could be read" in str(bag.damage)


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
def test_fewer_messages_than_counted_are_told_with_what_is_there(ending: str, tmp_path: Path) -> None:
    bag_of(tmp_path / "walk", ending, count=40)
    bag = only(tmp_path)
    assert localized(bag.trouble, "en") == FEWER
    assert (bag.messages, bag.topics) == (20, 1)


def read(bag: Bag) -> list[str]:
    return [raw[8:-1].decode() for _topic, _stamp, raw in bag.messages()]


def words_up_to(count: int) -> list[str]:
    return [f"m{number}" for number in range(count)]


def refusal(path: Path) -> str:
    with pytest.raises(BagError) as told:
        open_bag(path)
    return str(told.value)


def all_of(path: Path, count: int) -> tuple[str, ...]:
    """What is told of a bag that is read to its last message, and is not incomplete."""
    with open_bag(path) as bag:
        assert read(bag) == words_up_to(count)
        assert [(topic.name, topic.messages) for topic in bag.topics] == [(TOPIC, count)]
        assert (bag.messages_count, bag.is_incomplete, bag.damage) == (count, False, None)
        return bag.notes


def part_of(path: Path, count: int) -> tuple[str, ...]:
    """What is told of a bag of which only `count` messages are there."""
    with open_bag(path) as bag:
        assert read(bag) == words_up_to(count)
        assert (bag.messages_count, bag.is_incomplete) == (count, True)
        return bag.notes


@pytest.mark.parametrize("ending", ["mcap", "db3"])
def test_all_files_of_a_split_bag_are_read_and_counted_together(tmp_path: Path, ending: str) -> None:
    write = write_mcap if ending == "mcap" else write_sqlite
    for part, first in ((1, 0), (2, 10), (10, 20)):
        write(tmp_path / f"walk_{part}.{ending}", 10, first)
    assert all_of(tmp_path, 30) == ()


def test_a_missing_file_is_named_and_what_it_held_is_counted(tmp_path: Path) -> None:
    write_mcap(tmp_path / "walk_0.mcap")
    write_metadata(tmp_path, ["walk_0.mcap", "walk_1.mcap"], 40)
    assert part_of(tmp_path, 20) == (
        "metadata.yaml names walk_1.mcap, which is not there",
        "metadata.yaml counts 40 messages, the files hold 20",
    )


def test_of_a_split_bag_the_file_that_was_cut_is_named(tmp_path: Path) -> None:
    for number in range(3):
        write_mcap(tmp_path / f"walk_{number}.mcap", 10, first=10 * number)
    middle = tmp_path / "walk_1.mcap"
    middle.write_bytes(middle.read_bytes()[: middle.stat().st_size // 2])
    with open_bag(tmp_path) as bag:
        (note,) = bag.notes
    assert note.startswith("walk_1.mcap was cut short,")
    assert " messages are intact" in note
    assert ". 30 messages" not in note


def test_a_file_that_cannot_be_read_does_not_cost_the_others(tmp_path: Path) -> None:
    write_mcap(tmp_path / "walk_0.mcap")
    (tmp_path / "walk_1.mcap").write_bytes(b"")
    write_metadata(tmp_path, ["walk_0.mcap", "walk_1.mcap"], 40)
    notes = part_of(tmp_path, 20)
    assert "walk_1.mcap is empty, nothing was written to it" in notes[0]


@pytest.mark.parametrize("said", [19, 21])
def test_another_number_in_the_metadata_is_told(tmp_path: Path, said: int) -> None:
    write_mcap(tmp_path / "walk_0.mcap")
    write_metadata(tmp_path, ["walk_0.mcap"], said)
    notes = (part_of if said > 20 else all_of)(tmp_path, 20)
    assert notes == (f"metadata.yaml counts {said} messages, the files hold 20",)


@pytest.mark.parametrize("text", ["", "a: [", "[]", "rosbag2_bagfile_information: 3", "[" * 5000])
def test_broken_metadata_are_told_and_the_files_are_read(tmp_path: Path, text: str) -> None:
    write_mcap(tmp_path / "walk_0.mcap")
    (tmp_path / "metadata.yaml").write_text(text)
    assert all_of(tmp_path, 20) == ("metadata.yaml is damaged: only the files themselves count",)


FOREIGN = [
    ("json", "Log", "jsonschema"),
    ("protobuf", "demo.Pose", "protobuf"),
    ("ros1", "std_msgs/String", "ros1msg"),
    ("flatbuffer", "Pose", "flatbuffer"),
    ("cbor", "Pose", ""),
]


@pytest.mark.parametrize("foreign", FOREIGN)
@pytest.mark.parametrize("statistics", [True, False])
def test_a_channel_of_another_kind_is_named_and_the_others_are_read(
    tmp_path: Path, foreign: tuple[str, str, str], *, statistics: bool
) -> None:
    file = write_mcap(tmp_path / "walk.mcap", foreign=foreign, statistics=statistics)
    assert all_of(file, 20) == (
        f"left out, since their serialization format is not ROS 2's: /extra ({foreign[0]}: 20)",
    )


@pytest.mark.parametrize(
    ("name", "begin", "words"),
    [
        ("robot.bag", b"#ROSBAG V2.0\n", "is a recording of ROS 1; convert it: `pip install"),
        ("robot.mcap", b"#ROSBAG V2.0\n", "rosbags-convert --src robot.mcap --dst robot`"),
        ("a.mcap", b"version https://git-lfs.github.com/spec/v1\noid", "is a Git LFS pointer"),
        ("a.db3", b"version https://git-lfs.github.com/spec/v1\noid", "`git lfs pull`"),
        ("a.mcap", b"\n<!DOCTYPE html><html>", "is a web page and no recording"),
        ("a.mcap", b"PK\x03\x04rest", "is packed by zip; unpack it first"),
        ("a.db3", b"\x1f\x8brest", "is packed by gzip; unpack it first"),
    ],
)
def test_what_a_file_is_instead_is_told(tmp_path: Path, name: str, begin: bytes, words: str) -> None:
    file = tmp_path / "walk" / name
    file.parent.mkdir()
    file.write_bytes(begin + b"\0" * 64)
    for path in (file, file.parent):
        said = refusal(path)
        assert f"{path} cannot be read: {name} is " in said
        assert words in said
        assert "reindex" not in said


@pytest.mark.parametrize("place", ["middle", "end"])
def test_a_damaged_database_is_refused_by_its_name_with_what_saves_the_rest(tmp_path: Path, place: str) -> None:
    file = write_sqlite(tmp_path / "walk_0.db3", 5000)
    raw = bytearray(file.read_bytes())
    if place == "middle":
        middle = len(raw) // 2 // 4096 * 4096
        raw[middle : middle + 4096] = b"\xff" * 4096
    else:
        del raw[len(raw) // 3 :]
    file.write_bytes(raw)
    said = refusal(tmp_path)
    assert f"{tmp_path} cannot be read: walk_0.db3 is damaged (" in said
    assert "`sqlite3 walk_0.db3 .recover | sqlite3 new.db3`" in said


def test_a_database_that_is_not_complete_or_no_bag_is_refused_by_its_name(tmp_path: Path) -> None:
    file = write_sqlite(tmp_path / "walk#1%.db3")
    assert all_of(file, 20) == ()
    (tmp_path / "walk#1%.db3-wal").write_bytes(b"some")
    assert "a part of it is still in walk#1%.db3-wal: it is being written" in refusal(file)
    other = tmp_path / "other.db3"
    with closing(sqlite3.connect(other)) as base:
        base.execute("create table notes(words text)")
    assert "other.db3 is a database, but not of a recording" in refusal(other)


@pytest.mark.parametrize("indexes", [IndexType.ALL, IndexType.NONE])
@pytest.mark.parametrize("compression", list(CompressionType))
@pytest.mark.parametrize(("which", "begin"), [(1, 40), (1, 0), (-1, 40)])
def test_what_a_damaged_chunk_and_the_rest_held_is_counted_with_an_index_or_without(
    tmp_path: Path, which: int, begin: int, compression: CompressionType, indexes: IndexType
) -> None:
    file = write_mcap(tmp_path / "walk.mcap", 30, indexes=indexes, compression=compression, chunk_bytes=400)
    damage_chunk(file, which, begin)
    with open_bag(file) as bag:
        found = read(bag)
        assert found == words_up_to(len(found))
        assert 0 < len(found) < 30
        told = " ".join((*bag.notes, bag.damage or ""))
        if indexes is IndexType.NONE:
            assert f"was cut short, or is damaged: {len(found)} messages are intact" in told
            assert f"counts 30 messages of its own, and holds {len(found)}" in told
        else:
            assert f"of 30 messages only {len(found)} could be read" in told


@pytest.mark.parametrize("left_out", ["repeat_channels", "repeat_schemas"])
def test_a_whole_file_whose_summary_leaves_something_out_is_read(tmp_path: Path, left_out: str) -> None:
    file = write_mcap(tmp_path / "walk.mcap", summary={left_out: False})
    assert all_of(file, 20) == ()
    with open_bag(file) as bag:
        assert [topic.kind.name for topic in bag.topics] == [TEXT]


@pytest.mark.parametrize("chunk_bytes", [400, 2**20])
def test_what_is_left_of_a_file_is_read_in_the_order_of_time_and_from_any_time(
    tmp_path: Path, chunk_bytes: int
) -> None:
    file = tmp_path / "walk.mcap"
    write_mcap(file, 5000, chunk_bytes=chunk_bytes, compression=CompressionType.NONE, backwards=True)
    file.write_bytes(file.read_bytes()[:-8])
    with open_bag(file) as bag:
        assert read(bag) == words_up_to(5000)
        stamps = [stamp for _topic, stamp, _raw in bag.messages(times(2000, 1)[0])]
        assert stamps == times(2000, 3000)


def test_of_what_is_left_of_a_file_no_more_is_read_than_is_wanted(tmp_path: Path, long_bag: bytes) -> None:
    file = write_bag(tmp_path / "walk") / "walk.mcap"
    file.write_bytes(long_bag[:-8])
    with open_bag(file) as bag:
        third = len(long_bag) // 3
        file.write_bytes(long_bag[:third] + bytes(third) + long_bag[2 * third : -8])
        assert len(list(bag.messages(bag.end_ns - 10**9))) == 21
        assert len(list(bag.messages(names=["/map_name"]))) == 1
        assert bag.damage is None


def test_a_name_without_its_slash_is_resolved_as_ros_does_and_kept_as_it_is_recorded(tmp_path: Path) -> None:
    write_mcap(tmp_path / "walk_0.mcap", 10, topic=TOPIC.removeprefix("/"))
    write_mcap(tmp_path / "walk_1.mcap", 10, first=10)
    with open_bag(tmp_path) as bag:
        recorded = [(topic.name, topic.recorded) for topic in bag.topics]
        assert recorded == [(TOPIC, TOPIC), (TOPIC, "chatter")]
        assert {topic.name for topic, _stamp, _raw in bag.messages(names=[TOPIC])} == {TOPIC}
        rows = ReplayTopics(bag.topics).rows(Interest(), 0.0, 0.0)
        assert [(row.name, row.type_names) for row in rows] == [(TOPIC, ("std_msgs/msg/String",))]
        assert read(bag) == words_up_to(20)
