"""Bags of other programs, versions and accidents: what is there is read, what differs is told."""

from __future__ import annotations

import os
import sqlite3
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest
from mcap.writer import CompressionType, IndexType
from rosbags.rosbag2.storage_mcap import zstd  # type: ignore[attr-defined]

from graph.bag.errors import BagError
from graph.bag.reading import Bag, open_bag
from graph.observer.interest import Interest
from graph.replay.topics import ReplayTopics
from tests.unit.odd_bags import (
    DEFINITION,
    NUMBERED_QOS,
    TENTH_NS,
    TOPIC,
    damage_chunk,
    put,
    text_in_cdr,
    times,
    write_mcap,
    write_metadata,
    write_sqlite,
)

NAMED_QOS = {"reliability": "best_effort", "durability": "transient_local", "depth": 10}


def read(bag: Bag) -> list[str]:
    """The texts on all topics, in their order."""
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


@pytest.mark.parametrize("stated", ["", "- history: [", [NAMED_QOS], NUMBERED_QOS, [1], None, 7])
def test_qos_that_is_written_otherwise_in_metadata_costs_no_message(
    tmp_path: Path, stated: object
) -> None:
    write_mcap(tmp_path / "walk" / "walk_0.mcap", qos=NUMBERED_QOS)
    write_metadata(tmp_path / "walk", ["walk_0.mcap"], topics={"offered_qos_profiles": stated})
    assert all_of(tmp_path / "walk", 20) == ()
    with open_bag(tmp_path / "walk") as bag:
        assert (bag.topics[0].reliability, bag.topics[0].durability) == (
            "best_effort",
            "transient_local",
        )


@pytest.mark.parametrize(
    ("other", "told"),
    [
        ({"reliability": "reliable"}, "reliable, the files best_effort"),
        ({"durability": "volatile"}, "volatile, the files transient_local"),
        (
            {"reliability": "reliable", "durability": "volatile"},
            "reliable, volatile, the files best_effort, transient_local",
        ),
    ],
)
def test_another_qos_in_the_metadata_is_told_and_that_of_the_file_counts(
    tmp_path: Path, other: dict[str, str], told: str
) -> None:
    write_mcap(tmp_path / "walk" / "walk_0.mcap", qos=NUMBERED_QOS)
    stated = [{**NAMED_QOS, **other}]
    write_metadata(tmp_path / "walk", ["walk_0.mcap"], topics={"offered_qos_profiles": stated})
    (note,) = all_of(tmp_path / "walk", 20)
    assert note == f"metadata.yaml gives /chatter the QoS {told}; these count"
    with open_bag(tmp_path / "walk") as bag:
        assert bag.topics[0].reliability == "best_effort"


@pytest.mark.parametrize("stated", [[NAMED_QOS], NUMBERED_QOS])
def test_qos_that_only_the_metadata_know_is_theirs(tmp_path: Path, stated: object) -> None:
    write_sqlite(tmp_path / "walk_0.db3", qos=None)
    write_metadata(
        tmp_path,
        ["walk_0.db3"],
        storage_identifier="sqlite3",
        topics={"offered_qos_profiles": stated},
    )
    with open_bag(tmp_path) as bag:
        assert (bag.topics[0].reliability, bag.notes) == ("best_effort", ())


@pytest.mark.parametrize("ending", ["mcap", "db3"])
def test_all_files_of_a_split_bag_are_read_and_counted_together(
    tmp_path: Path, ending: str
) -> None:
    write = write_mcap if ending == "mcap" else write_sqlite
    for part, first in ((1, 0), (2, 10), (10, 20)):
        write(tmp_path / f"walk_{part}.{ending}", 10, first)
    assert all_of(tmp_path, 30) == ()


def test_a_missing_file_is_named_and_what_it_held_is_counted(tmp_path: Path) -> None:
    write_mcap(tmp_path / "walk_0.mcap")
    write_metadata(tmp_path, ["walk_0.mcap", "walk_1.mcap"], 40)
    assert part_of(tmp_path, 20) == (
        "metadata.yaml names walk_1.mcap, which is not there",
        "metadata.yaml counts 40 messages, the files hold 20: /chatter 40 → 20",
    )


def test_a_file_that_cannot_be_read_does_not_cost_the_others(tmp_path: Path) -> None:
    write_mcap(tmp_path / "walk_0.mcap")
    (tmp_path / "walk_1.mcap").write_bytes(b"")
    write_metadata(tmp_path, ["walk_0.mcap", "walk_1.mcap"], 40)
    notes = part_of(tmp_path, 20)
    assert "walk_1.mcap is empty, nothing was written to it" in notes[0]


def test_a_renamed_file_is_read(tmp_path: Path) -> None:
    write_mcap(tmp_path / "other.mcap")
    write_metadata(tmp_path, ["walk_0.mcap"])
    assert all_of(tmp_path, 20) == ("metadata.yaml names walk_0.mcap, which is not there",)


def test_a_file_that_goes_on_is_read_and_a_copy_is_not(tmp_path: Path) -> None:
    for file, first in (("walk_0", 0), ("walk_1", 20), ("copy", 0)):
        write_mcap(tmp_path / f"{file}.mcap", 20, first)
    write_metadata(tmp_path, ["walk_0.mcap"])
    assert [words.partition(":")[0] for words in all_of(tmp_path, 40)] == [
        "copy.mcap is not read",
        "walk_1.mcap is read, too",
        "metadata.yaml counts 20 messages, the files hold 40",
    ]


@pytest.mark.parametrize("said", [19, 21])
def test_another_number_in_the_metadata_is_told(tmp_path: Path, said: int) -> None:
    write_mcap(tmp_path / "walk_0.mcap")
    write_metadata(tmp_path, ["walk_0.mcap"], said)
    notes = (part_of if said > 20 else all_of)(tmp_path, 20)
    assert notes == (
        f"metadata.yaml counts {said} messages, the files hold 20: /chatter {said} → 20",
    )


def test_another_type_and_another_serialization_in_the_metadata_are_told(tmp_path: Path) -> None:
    write_mcap(tmp_path / "walk_0.mcap")
    about = {"type": "std_msgs/msg/Bool", "serialization_format": "cbor"}
    write_metadata(tmp_path, ["walk_0.mcap"], topics=about)
    assert all_of(tmp_path, 20) == (
        (
            "metadata.yaml gives /chatter the type std_msgs/msg/Bool, "
            "the files std_msgs/msg/String; these count"
        ),
        "metadata.yaml gives /chatter the serialization format cbor, the files cdr; these count",
    )


@pytest.mark.parametrize("storage", ["", None, "mcap", "MCAP2"])
def test_what_a_file_is_is_told_by_its_beginning(tmp_path: Path, storage: str | None) -> None:
    write_mcap(tmp_path / "walk_0.mcap").rename(tmp_path / "walk_0")
    write_metadata(tmp_path, ["walk_0"], storage_identifier=storage)
    all_of(tmp_path, 20)
    all_of(tmp_path / "walk_0", 20)


def test_a_storage_that_is_another_is_told(tmp_path: Path) -> None:
    write_mcap(tmp_path / "walk_0.mcap")
    write_metadata(tmp_path, ["walk_0.mcap"], storage_identifier="sqlite3")
    assert all_of(tmp_path, 20) == ("metadata.yaml names the storage sqlite3, walk_0.mcap is mcap",)


@pytest.mark.parametrize("version", [1, 4, 6, 8, 9, 12])
def test_metadata_of_every_version_are_understood(tmp_path: Path, version: int) -> None:
    write_mcap(tmp_path / "walk" / "walk_0.mcap")
    write_metadata(tmp_path / "walk", ["walk/walk_0.mcap"], version=version, files=None)
    assert all_of(tmp_path / "walk", 20) == ()


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


def test_a_file_without_any_message_of_ros_2_is_refused_by_name(tmp_path: Path) -> None:
    file = write_sqlite(tmp_path / "walk.db3", encoding="cbor")
    assert "is not ROS 2's: /chatter (cbor: 20)" in refusal(file)


def test_a_profile_that_is_not_named_is_no_matter(tmp_path: Path) -> None:
    assert all_of(write_mcap(tmp_path / "walk.mcap", profile=""), 20) == ()


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
def test_what_a_file_is_instead_is_told(
    tmp_path: Path, name: str, begin: bytes, words: str
) -> None:
    file = tmp_path / "walk" / name
    file.parent.mkdir()
    file.write_bytes(begin + b"\0" * 64)
    for path in (file, file.parent):
        said = refusal(path)
        assert f"{path} cannot be read: {name} is " in said
        assert words in said
        assert "reindex" not in said


@pytest.mark.parametrize("ending", ["mcap", "db3"])
def test_files_that_are_packed_are_read(tmp_path: Path, ending: str) -> None:
    write = write_mcap if ending == "mcap" else write_sqlite
    file = write(tmp_path / f"walk_0.{ending}", 20)
    packed = tmp_path / f"walk_0.{ending}.zstd"
    packed.write_bytes(zstd.compress(file.read_bytes()))
    file.unlink()
    all_of(tmp_path, 20)
    all_of(packed, 20)
    facts: dict[str, Any] = {
        "storage_identifier": "mcap" if ending == "mcap" else "sqlite3",
        "compression_format": "zstd",
        "compression_mode": "FILE",
    }
    write_metadata(tmp_path, [packed.name], **facts)
    assert all_of(tmp_path, 20) == ()
    packed.rename(tmp_path / "walk_0.zst")
    write_metadata(tmp_path, ["walk_0.zst"], **facts)
    assert all_of(tmp_path, 20) == ()
    write(file, 20)
    (tmp_path / "walk_0.zst").unlink()
    write_metadata(tmp_path, [packed.name], **facts)
    assert all_of(tmp_path, 20) == (), "it has been unpacked since"


def test_a_packed_file_that_was_cut_is_read_as_far_as_it_goes(tmp_path: Path) -> None:
    whole = write_mcap(tmp_path / "walk.mcap", 100, chunked=False).read_bytes()
    packed = zstd.compress(whole[:2000]) + zstd.compress(whole[2000:])
    file = tmp_path / "cut.mcap.zstd"
    file.write_bytes(packed[:-30])
    with open_bag(file) as bag:
        found = read(bag)
        assert found == words_up_to(len(found))
        assert 0 < len(found) < 100
        assert bag.is_cut


def test_messages_that_are_packed_are_read_and_damaged_ones_counted(tmp_path: Path) -> None:
    raws = [zstd.compress(text_in_cdr(f"m{number}")) for number in range(20)]
    facts: dict[str, Any] = {"storage_identifier": "sqlite3", "compression_mode": "MESSAGE"}
    write_metadata(tmp_path, ["walk_0.db3"], compression_format="zstd", **facts)
    write_sqlite(tmp_path / "walk_0.db3", contents=raws)
    assert all_of(tmp_path, 20) == ()
    raws[3] = raws[3][:6]
    (tmp_path / "walk_0.db3").unlink()
    write_sqlite(tmp_path / "walk_0.db3", contents=raws)
    with open_bag(tmp_path) as bag:
        assert len(read(bag)) == len(read(bag)) == 19
        assert "messages lost: 1, damaged places: 1, the first 0.3 s" in str(bag.damage)
    write_metadata(tmp_path, ["walk_0.db3"], compression_format="lz5", **facts)
    assert "it is packed by lz5, and only zstd is known" in refusal(tmp_path)


def test_what_sqlite_has_not_put_into_its_file_yet_is_read(tmp_path: Path) -> None:
    file = write_sqlite(tmp_path / "walk.db3", 5)
    with closing(sqlite3.connect(file)) as writing:
        writing.execute("pragma journal_mode=wal")
        put(writing, 15, 5)
        writing.commit()
        assert all_of(file, 20) == ()
        beside = sorted(path.name for path in tmp_path.iterdir())
        assert beside == ["walk.db3", "walk.db3-shm", "walk.db3-wal"]


@pytest.mark.parametrize("encoding", ["ros2msg", "unknown", ""])
def test_a_database_with_definitions_of_any_kind_is_read(tmp_path: Path, encoding: str) -> None:
    file = write_sqlite(tmp_path / "walk.db3", definitions=(encoding, DEFINITION.decode()))
    assert all_of(file, 20) == ()


def test_a_database_of_something_else_is_told(tmp_path: Path) -> None:
    file = tmp_path / "walk.db3"
    with closing(sqlite3.connect(file)) as base:
        base.execute("create table letters(text)")
    assert refusal(file) == f"{file} cannot be read: walk.db3 is a database, but not of a recording"


@pytest.mark.parametrize("place", ["middle", "end"])
def test_a_damaged_database_is_read_from_both_ends(tmp_path: Path, place: str) -> None:
    count = 5000
    file = write_sqlite(tmp_path / "walk_0.db3", count)
    write_metadata(tmp_path, ["walk_0.db3"], count, storage_identifier="sqlite3")
    raw = bytearray(file.read_bytes())
    if place == "middle":
        middle = len(raw) // 2 // 4096 * 4096
        raw[middle : middle + 4096] = b"\xff" * 4096
    else:
        del raw[len(raw) // 3 :]
    file.write_bytes(raw)
    with open_bag(tmp_path) as bag:
        found = read(bag)
        assert found == sorted(found, key=lambda word: int(word[1:]))
        lost = count - len(found)
        assert count / 10 < len(found) < count
        if place == "middle":
            assert f"messages lost: {lost}," in str(bag.damage)
        assert bag.is_incomplete
        assert f"counts 5000 messages, the files hold {len(found)}" in bag.notes[0]


@pytest.mark.parametrize("name", ["a walk #1?.mcap", "50%20.db3", "прогулка.db3"])
def test_any_name_will_do(tmp_path: Path, name: str) -> None:
    write = write_mcap if name.endswith("mcap") else write_sqlite
    assert all_of(write(tmp_path / "a folder" / name, 20), 20) == ()
    assert all_of(tmp_path / "a folder", 20) == ()


@pytest.mark.parametrize("indexes", [IndexType.NONE, IndexType.CHUNK, IndexType.MESSAGE])
@pytest.mark.parametrize("statistics", [True, False])
@pytest.mark.parametrize("chunked", [True, False])
def test_a_file_with_any_index_or_none_is_read(
    tmp_path: Path, indexes: IndexType, *, statistics: bool, chunked: bool
) -> None:
    file = write_mcap(
        tmp_path / "walk.mcap", indexes=indexes, statistics=statistics, chunked=chunked
    )
    assert all_of(file, 20) == ()


DAMAGED_CHUNK = [
    # What the file counts: all its messages, those of a chunk at its end, those behind the chunk.
    pytest.param(statistics, indexes, id=f"{statistics}-{indexes.name}")
    for statistics, indexes in (
        (True, IndexType.ALL),
        (True, IndexType.NONE),
        (True, IndexType.CHUNK),
        (False, IndexType.ALL),
        (False, IndexType.MESSAGE),
    )
]


@pytest.mark.parametrize(("statistics", "indexes"), DAMAGED_CHUNK)
@pytest.mark.parametrize("compression", list(CompressionType))
@pytest.mark.parametrize("which", [0, 1, -1])
def test_what_a_damaged_chunk_held_is_counted_by_whatever_the_file_counts(
    tmp_path: Path,
    which: int,
    compression: CompressionType,
    indexes: IndexType,
    *,
    statistics: bool,
) -> None:
    file = write_mcap(
        tmp_path / "walk.mcap",
        30,
        statistics=statistics,
        indexes=indexes,
        compression=compression,
        chunk_bytes=400,
    )
    assert damage_chunk(file, which) > 2
    with open_bag(file) as bag:
        found = read(bag)
        assert 10 < len(found) < 30
        assert f"messages lost: {30 - len(found)}, damaged places: 1," in str(bag.damage)
        assert bag.notes == ()


@pytest.mark.parametrize("indexes", [IndexType.NONE, IndexType.CHUNK])
def test_how_many_messages_are_lost_is_said_not_to_be_known_where_nothing_counts_them(
    tmp_path: Path, indexes: IndexType
) -> None:
    file = tmp_path / "walk.mcap"
    write_mcap(file, 30, statistics=False, indexes=indexes, chunk_bytes=400)
    damage_chunk(file, 1)
    with open_bag(file) as bag:
        assert 10 < len(read(bag)) < 30
        assert "messages lost: how many cannot be known, damaged places: 1," in str(bag.damage)


@pytest.mark.parametrize("indexes", [IndexType.ALL, IndexType.CHUNK, IndexType.NONE])
def test_a_file_that_is_broken_in_its_middle_and_has_an_end_was_not_cut_short(
    tmp_path: Path, indexes: IndexType
) -> None:
    file = write_mcap(tmp_path / "walk.mcap", 30, indexes=indexes, chunk_bytes=400)
    damage_chunk(file, 1, begin=0)
    with open_bag(file) as bag:
        found = read(bag)
        assert f"messages lost: {30 - len(found)}, damaged places: 1," in str(bag.damage)
        assert not bag.is_cut
        # By the indexes of the other chunks what follows is found.
        assert ("m29" in found) == (indexes is not IndexType.NONE)


def test_a_database_that_was_cut_does_not_say_how_much_has_gone(tmp_path: Path) -> None:
    file = write_sqlite(tmp_path / "walk.db3", 5000)
    file.write_bytes(file.read_bytes()[: file.stat().st_size // 3])
    with open_bag(file) as bag:
        assert 500 < len(read(bag)) < 5000
        assert "messages lost: how many cannot be known, " in str(bag.damage)


def test_a_name_without_its_slash_is_resolved_as_ros_does_and_kept_as_it_is_recorded(
    tmp_path: Path,
) -> None:
    write_mcap(tmp_path / "walk_0.mcap", 10, topic=TOPIC.removeprefix("/"))
    write_mcap(tmp_path / "walk_1.mcap", 10, first=10)
    with open_bag(tmp_path) as bag:
        assert [(topic.name, topic.recorded) for topic in bag.topics] == [
            (TOPIC, TOPIC),
            (TOPIC, "chatter"),
        ]
        assert {topic.name for topic, _stamp, _raw in bag.messages(names=[TOPIC])} == {TOPIC}
        rows = ReplayTopics(bag.topics).rows(Interest(), 0.0, 0.0)
        assert [(row.name, row.type_names) for row in rows] == [(TOPIC, ("std_msgs/msg/String",))]
        assert read(bag) == words_up_to(20)


def test_messages_out_of_order_come_in_their_order(tmp_path: Path) -> None:
    stamps = list(times(0, 20))
    stamps[4], stamps[15] = stamps[15], stamps[4]
    file = write_mcap(tmp_path / "walk.mcap", stamps=stamps, chunked=False)
    with open_bag(file) as bag:
        found = [stamp for _topic, stamp, _raw in bag.messages()]
        assert found == sorted(stamps)
        assert len(list(bag.messages(stamps[0] + 10 * TENTH_NS))) == 10


def test_fewer_messages_than_a_file_itself_counts_are_told(tmp_path: Path) -> None:
    file = write_mcap(tmp_path / "walk.mcap", chunked=False)
    raw = bytearray(file.read_bytes())
    place = raw.index(b"\x05" + (22 + 11).to_bytes(8, "little"))
    raw[place] = 0x80
    file.write_bytes(raw)
    with open_bag(file) as bag:
        assert len(read(bag)) == 19
        assert bag.is_incomplete
        assert bag.notes == ("walk.mcap counts 20 messages of its own, and holds 19",)


def test_an_empty_bag_is_whole(tmp_path: Path) -> None:
    write_mcap(tmp_path / "walk_0.mcap", 0)
    write_metadata(tmp_path, ["walk_0.mcap"], 0, duration={"nanoseconds": 0})
    with open_bag(tmp_path) as bag:
        assert (list(bag.messages()), bag.notes, bag.length_s) == ([], (), 0.0)


def test_a_file_that_may_not_be_read_is_told(tmp_path: Path) -> None:
    file = write_mcap(tmp_path / "walk.mcap")
    file.chmod(0)
    if os.access(file, os.R_OK):
        file.unlink()
        file.symlink_to(tmp_path / "gone" / "walk.mcap")
        assert "there is no such file or folder" in refusal(file)
    else:
        assert "cannot be read: Permission denied" in refusal(file)
