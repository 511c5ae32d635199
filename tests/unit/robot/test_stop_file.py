"""The emergency stop on disk: seen by all who watch it, released by nothing but a release."""

from __future__ import annotations

import json
import stat
import subprocess
import sys
import time
from pathlib import Path

import pytest

from robot.safety.stop_file import BY_SCREEN, KeptStop, StopFile
from robot.safety.stop_record import Stop, StopRecord
from tests.waiting import wait_until

FIRST, SECOND = Stop(5, 1), Stop(6, 1)
STOP = KeptStop(1000.0, "topic", "/somebody")


@pytest.fixture
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("DECK_STATE_DIR", str(tmp_path / "state"))
    return tmp_path / "state/stops/7"


def record(*stops: Stop) -> StopRecord:
    return StopRecord().stopped(*stops)


def test_what_one_writes_another_sees_and_reads(place: Path) -> None:
    writer, reader = StopFile(7, "/a"), StopFile(7, "/b")
    before = reader.signature()
    assert writer.keep(STOP, record(FIRST)) == ""
    assert reader.signature() != before
    saved = reader.read()
    assert saved.record == record(FIRST)
    assert saved.stop == STOP._replace(remembered=True)
    assert stat.S_IMODE(place.stat().st_mode) == 0o600
    before = reader.signature()
    assert writer.forget(record(FIRST).freed()) == ""
    assert reader.signature() != before
    assert not place.exists()
    assert reader.read()[:2] == (record(FIRST).freed(), None)


def test_a_file_that_is_removed_by_hand_releases_nothing(place: Path) -> None:
    file = StopFile(7, "/a")
    file.keep(STOP, record(FIRST))
    place.unlink()
    assert file.read().record.merged(record(FIRST)).engaged


def test_a_release_leaves_a_stop_that_came_after_it(place: Path) -> None:
    file, another = StopFile(7, "/a"), StopFile(7, "/b")
    file.keep(STOP, record(FIRST))
    another.keep(STOP, record(SECOND))
    assert file.read().record.held == {FIRST, SECOND}
    file.forget(record(FIRST).freed())
    assert place.exists()
    assert another.read().record.held == {SECOND}
    # Even where the copy of the first one is what has stayed.
    place.write_text(json.dumps({"since": 1.0, "by": "topic", **record(FIRST).texts()}))
    assert another.read().stop is None


@pytest.mark.usefixtures("place")
def test_the_first_details_stay() -> None:
    StopFile(7, "/a").keep(STOP, record(FIRST))
    StopFile(7, "/b").keep(KeptStop(2000.0, "pico"), record(FIRST, SECOND))
    stop = StopFile(7, "/c").read().stop
    assert stop == STOP._replace(remembered=True)


@pytest.mark.usefixtures("place")
def test_a_part_is_enough_unless_all_is_wanted() -> None:
    file = StopFile(7, "/a")
    file.keep(STOP, record(FIRST))
    before = file.signature()
    file.keep(STOP, record(FIRST, SECOND), whole=False)
    assert file.signature() == before
    file.keep(STOP, record(FIRST, SECOND))
    assert file.read().record.held == {FIRST, SECOND}


def test_the_file_of_an_older_deck_is_a_stop_with_a_name_of_its_own(place: Path) -> None:
    place.parent.mkdir(parents=True)
    place.write_text('{"since": 1700000000.5, "by": "topic", "publishers": "/x"}')
    file = StopFile(7, "/a")
    (stop,) = file.read().record.held
    assert StopFile(7, "/b").read().record.held == {stop}
    file.forget(file.read().record.freed())
    assert not place.exists()


@pytest.mark.parametrize(
    "text",
    [
        "",
        "{",
        "[]",
        "7",
        '{"since": "x", "by": ""}',
        '{"since": 1e999, "by": ""}',
        "\0",
        "[" * 8000,
    ],
)
def test_what_makes_no_sense_is_one_stop_for_all_who_read_it(place: Path, text: str) -> None:
    place.parent.mkdir(parents=True)
    place.write_text(text)
    one, two = StopFile(7, "/a").read(), StopFile(7, "/b").read()
    assert one.record.engaged
    assert one.record == two.record
    assert one.stop is not None
    assert one.stop.unreadable
    StopFile(7, "/a").forget(one.record.freed())
    assert not place.exists()


def test_a_place_that_cannot_be_looked_at_is_a_stop_once(place: Path) -> None:
    place.parent.parent.write_text("no folder")
    file = StopFile(7, "/a")
    saved = file.read()
    assert saved.stop is not None
    freed = saved.record.freed()
    assert file.forget(freed)  # It says why it could not.
    assert not freed.merged(file.read().record).engaged
    assert file.keep(STOP, record(FIRST))


def test_a_released_list_that_makes_no_sense_releases_nothing(place: Path) -> None:
    file = StopFile(7, "/a")
    file.keep(STOP, record(FIRST))
    place.with_name("7.released").write_text("{")
    assert file.read().record.held == {FIRST}


def test_a_link_in_the_place_of_the_draft_is_not_followed(place: Path, tmp_path: Path) -> None:
    place.parent.mkdir(parents=True)
    (place.parent / ".7.a").symlink_to(tmp_path / "elsewhere")
    assert StopFile(7, "/a").keep(STOP, record(FIRST))
    assert not (tmp_path / "elsewhere").exists()


def test_after_the_clock_was_set_back_the_second_release_frees(place: Path) -> None:
    file = StopFile(7, "/a")
    file.give(Stop(time.time_ns()), BY_SCREEN)
    document = json.loads(place.read_text())
    later_ns = time.time_ns() + 3600 * 10**9
    place.write_text(json.dumps({**document, "written_ns": later_ns, "stops": f"{later_ns}.0"}))
    assert file.release(time.time_ns()) == ""
    assert file.read().record.engaged
    assert file.release(time.time_ns()) == ""
    assert not place.exists()


def test_a_release_that_is_carried_out_late_leaves_what_came_since(place: Path) -> None:
    file, said_ns = StopFile(7, "/a"), time.time_ns()
    file.give(Stop(said_ns + 1), BY_SCREEN)
    assert file.release(said_ns) == ""
    assert place.exists()
    assert file.release(said_ns + 2) == ""
    assert not place.exists()


GIVEN = 150


def test_no_stop_is_lost_beside_one_that_forgets_what_was_released(place: Path) -> None:
    """As a free node does each second; here without a pause, from another process."""
    released = record(FIRST).freed()
    forget = (
        "from robot.safety.stop_file import StopFile;"
        "from robot.safety.stop_record import read_record;"
        "file = StopFile(7, '/b');"
        f"record = read_record('', {released.texts()['released']!r})\n"
        "while True: file.forget(record)"
    )
    another = subprocess.Popen([sys.executable, "-c", forget])
    try:
        file = StopFile(7, "/a")
        wait_until(place.with_name("7.released").exists, "the first one forgotten")
        for number in range(GIVEN):
            stop = Stop(time.time_ns(), number + 1)
            assert file.give(stop, BY_SCREEN) == ""
            assert file.read().record.held == {stop}
            file.forget(record(stop).freed())
    finally:
        another.kill()
        another.wait()
