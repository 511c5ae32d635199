"""`ros2 bag`: recorded by the line that Deck's screens copy, looked at, and played elsewhere."""

from __future__ import annotations

import os
import re
import shlex
import signal
import threading
from typing import TYPE_CHECKING

import pytest
from std_msgs.msg import String

from graph.bag.reading import open_bag
from tests.ros.peer import LATCHED
from tests.ros.ros2.typed import Typed, typed
from tests.unit.odd_bags import write_mcap, write_metadata, write_sqlite
from tests.waiting import comes, wait_until
from text import ros2_words

if TYPE_CHECKING:
    from pathlib import Path

    from tests.ros.ros2.world import World

pytestmark = pytest.mark.nightly

ENOUGH_BYTES = 6000


def recorded(folder: Path, *words: str) -> Typed:
    """Record until a second's worth is on the disk; then Ctrl-C."""
    file = folder / f"{folder.name}.mcap"

    def end() -> None:
        comes(lambda: file.exists() and file.stat().st_size > ENOUGH_BYTES, 30)
        os.kill(os.getpid(), signal.SIGINT)

    ending = threading.Thread(target=end)
    ending.start()
    done = typed(*words, "-o", str(folder))
    ending.join()
    return done


def test_what_is_recorded_is_shown_and_played(
    tmp_path: Path, world: World, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("TZ", "UTC")
    folder = tmp_path / "walk"
    line = shlex.split(ros2_words.record(["/word", "/wheels"]))[1:]
    done = recorded(folder, *line)
    assert (done.code, done.out) == (0, ""), done
    assert re.search(
        r"^\[INFO\] \[\d+\.\d{9}\] \[rosbag2_recorder\]: Subscribed to topic '/wheels'$",
        done.err,
        re.MULTILINE,
    )
    with open_bag(folder) as bag:
        counts = {topic.name: topic.messages for topic in bag.topics}
    assert counts.keys() == {"/wheels", "/word"}
    assert counts["/word"] == 1
    info = typed("bag", "info", str(folder)).out
    moment = r"[A-Z][a-z]{2} [ \d]\d \d{4} \d\d:\d\d:\d\d\.\d{9} \(\d+\.\d{9}\)"
    assert re.fullmatch(
        r"\nFiles:             walk\.mcap\n"
        r"Bag size:          \d+\.\d KiB\n"
        r"Storage id:        mcap\n"
        r"ROS Distro:        jazzy\n"
        r"Duration:          \d+\.\d{9}s\n"
        rf"Start:             {moment}\n"
        rf"End:               {moment}\n"
        rf"Messages:          {sum(counts.values())}\n"
        r"Topic information: Topic: /wheels \| Type: sensor_msgs/msg/JointState "
        rf"\| Count: {counts['/wheels']} \| Serialization Format: cdr\n"
        r"                   Topic: /word \| Type: std_msgs/msg/String "
        r"\| Count: 1 \| Serialization Format: cdr\n"
        r"Service:           0\n"
        r"Service information: \n",
        info,
    ), info
    assert typed("bag", "info", "-t", str(folder)).out == "/wheels\n/word\n"
    played = world.hear("/played", String, LATCHED)
    wheels = world.hear("/wheels_played", String)
    line = shlex.split(ros2_words.play(str(folder)))[1:]
    back = typed(*line, "--remap", "/word:=/played", "--topics", "word", "--rate", "10")
    assert (back.code, back.out) == (0, ""), back
    assert back.err.endswith("[rosbag2_player]: Set rate to 10\n")
    wait_until(lambda: played, "the word")
    assert [message.data for message in played] == ["вперёд: 'x' #1"]
    assert not wheels


def test_topics_are_chosen_by_pattern_and_type(tmp_path: Path) -> None:
    folder = tmp_path / "some"
    chosen = ("--regex", "^/w", "--topic-types", "std_msgs/msg/Float32")
    done = recorded(folder, "bag", "record", *chosen, "--exclude-topics", "/word")
    assert done.code == 0, done
    assert typed("bag", "info", "-t", str(folder)).out == "/distance\n/wheels\n"


@pytest.mark.parametrize(
    ("line", "code", "words"),
    [
        ("record", 1, "Need to specify at least one option out of --all, "),
        ("record -a -o {here}", 1, "[ERROR] [ros2bag]: Output folder '{here}' already exists."),
        ("record -a --max-bag-size 9", 2, "--max-bag-size is not in Deck's ros2"),
        ("play {here}/none", 2, "Bag path '{here}/none' does not exist!"),
        ("play {here} -m word", 1, "'word' is not a remapping"),
        ("info {here}", 1, "{here}"),
    ],
)
def test_what_cannot_be_done_is_said(tmp_path: Path, line: str, code: int, words: str) -> None:
    done = typed("bag", *(word.format(here=tmp_path) for word in line.split()))
    assert done.code == code, done
    assert words.format(here=tmp_path) in done.err


@pytest.mark.parametrize("ending", ["mcap", "db3"])
def test_all_files_of_a_bag_are_counted(tmp_path: Path, ending: str) -> None:
    write = write_mcap if ending == "mcap" else write_sqlite
    for part, (count, first) in enumerate(((30, 0), (12, 30))):
        write(tmp_path / f"walk_{part}.{ending}", count, first)
    done = typed("bag", "info", f"{tmp_path}/")
    assert (done.code, done.err) == (0, ""), done
    assert f"walk_0.{ending}\n                   walk_1.{ending}\n" in done.out
    assert "Messages:          42\n" in done.out
    assert "Topic: /chatter | Type: std_msgs/msg/String | Count: 42 |" in done.out


def test_a_recording_of_which_nothing_can_be_played_is_shown_and_refused(tmp_path: Path) -> None:
    write_mcap(tmp_path / "walk_0.mcap", topic="a name")
    assert typed("bag", "info", "-t", str(tmp_path)).out == "a name\n"
    done = typed("bag", "play", str(tmp_path))
    assert done.code == 2, done
    assert done.err.endswith(f"{tmp_path}: none of its topics can be published\n")


def test_what_is_missing_is_told_and_the_rest_is_shown_and_played(
    tmp_path: Path, world: World
) -> None:
    write_mcap(tmp_path / "walk_0.mcap", foreign=("protobuf", "demo.Pose", "protobuf"))
    write_metadata(tmp_path, ["walk_0.mcap", "walk_1.mcap"], 40)
    told = (
        "metadata.yaml names walk_1.mcap, which is not there",
        "metadata.yaml counts 40 messages, the files hold 20: /chatter 40 → 20",
        "left out, since their serialization format is not ROS 2's: /extra (protobuf: 20)",
    )
    info = typed("bag", "info", str(tmp_path))
    assert info.code == 1, info
    assert all(f"[ros2bag]: {words}\n" in info.err for words in told), info.err
    assert "Topic: /chatter | Type: std_msgs/msg/String | Count: 20 |" in info.out
    assert "Type: demo.Pose | Count: 20 | Serialization Format: protobuf" in info.out
    heard = world.hear("/played", String)
    played = typed("bag", "play", str(tmp_path), "-m", "/chatter:=/played", "--rate", "10")
    assert played.code == 1, played
    assert all(f"[rosbag2_player]: {words}\n" in played.err for words in told), played.err
    wait_until(lambda: len(heard) == 20, lambda: f"20 texts; there are {len(heard)}")
