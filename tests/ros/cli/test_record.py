"""`deck record` beside a real publisher: its lines, its end, its exit codes."""

from __future__ import annotations

import re
import signal
from pathlib import Path

import pytest
from std_msgs.msg import Float32

from tests.deck_process import DeckProcess, deck
from tests.middleware_words import own_words
from tests.ros.peer import Peer
from tests.ros.recorded import read_by_mcap
from tests.unfinished_shared_memory import make_old
from tests.waiting import wait_until


@pytest.fixture(autouse=True)
def _domain(ros_domain: int) -> int:
    return ros_domain


def publish_until_recorded(peer: Peer, run: DeckProcess, messages: str) -> None:
    """Go on publishing until the command tells of more `messages` than a node alone brings."""
    publisher = peer.publisher("/numbers", Float32)

    def said() -> bool:
        publisher.publish(Float32(data=1.0))
        return any(re.search(messages, line) for line in run.lines)

    wait_until(said, messages)


def test_it_records_until_ctrl_c_and_tells_each_second(ros_domain: int, tmp_path: Path) -> None:
    with Peer(ros_domain) as peer:
        run = DeckProcess("record", "-o", str(tmp_path / "bag"))
        run.said(f"recording domain {ros_domain} into")
        publish_until_recorded(peer, run, r"\d\d messages")
        run.signal(signal.SIGINT)
        assert run.finish() == 0
    assert own_words("\n".join(run.errors)) == ""
    assert any(line.startswith("/numbers") and "std_msgs/msg/Float32" in line for line in run.lines)
    assert run.lines[-1] == f"to see it: deck replay {tmp_path / 'bag'}"
    assert read_by_mcap(tmp_path / "bag")["/numbers"]


def test_json_tells_the_same_to_programs(ros_domain: int, tmp_path: Path) -> None:
    with Peer(ros_domain) as peer:
        run = DeckProcess("record", "/numbers", "/never", "-o", str(tmp_path / "b"), "--json")
        publish_until_recorded(peer, run, r'"messages": \d\d')
        run.signal(signal.SIGTERM)
        assert run.finish() == 0
    first, *_, last = run.events()
    assert (first["event"], first["domain"]) == ("recording", ros_domain)
    assert last["event"] == "summary"
    assert last["messages"] == len(read_by_mcap(tmp_path / "b")["/numbers"])
    assert last["complaints"] == ["nobody has published /never"]


def test_what_the_middleware_prints_is_not_among_the_json(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    profiles = tmp_path / "profiles.xml"
    profiles.write_text("<profiles><nonsense/></profiles>")
    monkeypatch.setenv("FASTRTPS_DEFAULT_PROFILES_FILE", str(profiles))
    run = deck("record", "-o", str(tmp_path / "bag"), "--for", "0.5", "--json")
    first, *_, last = run.events()
    assert (first["event"], last["event"]) == ("recording", "summary")
    assert any("nonsense" in line for line in run.errors)


def test_it_begins_where_a_process_was_killed_as_it_joined(
    unfinished: list[Path], tmp_path: Path
) -> None:
    make_old(unfinished)
    run = DeckProcess("record", "-o", str(tmp_path / "bag"), "--for", "0.5")
    assert run.finish() == 1
    assert any("nothing was recorded" in line for line in run.lines)


def test_when_nothing_came_it_says_so_and_fails(tmp_path: Path) -> None:
    run = deck("record", "-o", str(tmp_path / "bag"), "--for", "0.5")
    assert run.process.returncode == 1
    assert any("nothing was recorded" in line for line in run.lines)


def test_no_seconds_at_all_end_it_at_once(tmp_path: Path) -> None:
    run = deck("record", "-o", str(tmp_path / "bag"), "--for", "0")
    assert run.process.returncode == 1
    assert any("nothing was recorded" in line for line in run.lines)


def test_a_folder_that_is_there_is_refused_with_a_word(tmp_path: Path) -> None:
    run = deck("record", "-o", str(tmp_path))
    assert run.process.returncode == 2
    assert "already exists: choose another folder" in run.errors[0]


@pytest.mark.parametrize("name", ["/a//b", "/1st", "/a/", "sönar"])
def test_what_is_no_topic_name_is_refused_before_anything_is_recorded(
    name: str, tmp_path: Path
) -> None:
    run = deck("record", name, "-o", str(tmp_path / "bag"))
    assert run.process.returncode == 2
    assert f"'{name}' is not a valid topic name; write it as /sensor/sonar_front" in run.errors[0]
    assert not (tmp_path / "bag").exists()
