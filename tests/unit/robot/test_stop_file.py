"""The emergency stop on disk and as it spreads: known to all alike, lost by nobody."""

from __future__ import annotations

import json
import random
import stat
import subprocess
import sys
import time
from itertools import permutations
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from safety.stop_file import BY_SCREEN, KeptStop, SavedStop, StopFile, stop_place
from safety.stop_record import MOST_HELD, MOST_RELEASED, Insistence, Stop, StopRecord, read_record
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
        "", "{", "[]", "7", '{"since": "x", "by": ""}', '{"since": 1e999, "by": ""}', "\0",
        "[" * 8000,
    ],
)  # fmt: skip
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


def test_a_stop_given_while_a_released_one_is_removed_stays(place: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Whoever removes it may be held up for longer than a stop waits."""
    file, read, newer = StopFile(7, "/a"), StopFile.read, Stop(time.time_ns() + 1)
    file.give(FIRST, BY_SCREEN)

    def held_up(self: StopFile) -> SavedStop:
        saved = read(self)
        if self is file and not saved.record.engaged:
            StopFile(7, "/b").give(newer, BY_SCREEN)
        return saved

    with monkeypatch.context() as patch:
        patch.setattr(StopFile, "read", held_up)
        file.forget(record(FIRST).freed())
    assert file.read().record.held == {newer}
    assert sorted(each.name for each in place.parent.iterdir()) == ["7", "7.released"]


GIVEN = 150


def test_no_stop_is_lost_beside_one_that_forgets_what_was_released(place: Path) -> None:
    """As a free node does each second; here without a pause, from another process."""
    released = record(FIRST).freed()
    forget = (
        "from safety.stop_file import StopFile;"
        "from safety.stop_record import read_record;"
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


S = 1_000_000_000
NODES = 4
nodes = st.integers(0, NODES - 1)
clocks = st.sampled_from([0, -3600 * S, 3600 * S, 40 * S])
"""Two hosts, and two more that nobody has set right."""
words = st.tuples(st.sampled_from(["stop", "release"]), clocks, st.sets(nodes, min_size=1))
"""What a person says, by which clock, and which nodes hear it themselves."""
passed_on = st.tuples(st.just("state"), nodes, nodes)
restarts = st.tuples(st.just("restart"), nodes, st.booleans())
histories = st.lists(words | passed_on | restarts, max_size=20)


class Fleet:
    """Some nodes, two disks, and what was ever on the wire: any of that may arrive again."""

    def __init__(self) -> None:
        self.known = [StopRecord() for _ in range(NODES)]
        self.disks = [StopRecord(), StopRecord()]
        self.wire: list[tuple[int, StopRecord]] = []
        self.time_ns = 1000 * 3600 * S

    def say(self, what: str, clock_ns: int, hearers: set[int]) -> None:
        self.time_ns += S
        stop = Stop(self.time_ns + clock_ns, 1)
        for node in hearers:
            record = self.known[node]
            self.learn(node, record.stopped(stop) if what == "stop" else record.freed())

    def learn(self, node: int, record: StopRecord) -> None:
        self.known[node] = self.known[node].merged(record)
        self.wire.append((node, self.known[node]))
        if node != NODES - 1:  # The last one has no disk.
            self.disks[node % 2] = self.disks[node % 2].merged(self.known[node])

    def restart(self, node: int, has_disk: bool) -> None:
        self.known[node] = self.disks[node % 2] if has_disk and node != NODES - 1 else StopRecord()

    def settle(self, dice: random.Random) -> None:
        """Everybody hears everybody, at first among late and repeated news."""
        for late in (self.wire, [], []):
            news = [*late, *enumerate(self.known)]
            dice.shuffle(news)
            for _, record in news:
                for node in dice.sample(range(NODES), NODES):
                    self.known[node] = self.known[node].merged(record)

    def play(self, history: list[tuple[Any, ...]]) -> None:
        for what, first, second in history:
            if what == "state":
                self.learn(second, self.known[first])
            elif what == "restart":
                self.restart(first, second)
            else:
                self.say(what, first, second)


@given(histories, st.randoms(use_true_random=False))
def test_all_who_hear_of_each_other_end_alike(history: list[tuple[Any, ...]], dice: random.Random) -> None:
    fleet = Fleet()
    fleet.play(history)
    fleet.settle(dice)
    assert all(record == fleet.known[0] for record in fleet.known)


@given(histories, clocks, nodes, st.randoms(use_true_random=False))
def test_the_last_stop_is_never_lost_whatever_was_released_before(
    history: list[tuple[Any, ...]], clock_ns: int, hearer: int, dice: random.Random
) -> None:
    fleet = Fleet()
    fleet.play(history)
    fleet.say("stop", clock_ns, {hearer})
    fleet.settle(dice)
    assert all(record.engaged for record in fleet.known)


@given(histories, nodes, st.randoms(use_true_random=False))
def test_a_release_that_comes_after_all_is_known_frees_all(
    history: list[tuple[Any, ...]], hearer: int, dice: random.Random
) -> None:
    fleet = Fleet()
    fleet.play(history)
    fleet.settle(dice)
    fleet.say("release", 0, {hearer})
    fleet.settle(dice)
    assert not any(record.engaged for record in fleet.known)


def test_a_release_by_one_who_has_not_heard_of_the_stop_does_not_undo_it() -> None:
    first, second = Stop(5 * S, 1), Stop(3 * S, 1)  # The second by a clock that is slow.
    released = StopRecord().stopped(first).freed()
    unaware = StopRecord().stopped(first, second)
    assert released.merged(unaware).held == {second}
    assert unaware.merged(released) == released.merged(unaware)


def test_a_late_copy_of_a_released_stop_is_no_new_one() -> None:
    stop = Stop(5 * S, 1)
    freed = StopRecord().stopped(stop).freed()
    assert not freed.stopped(stop).engaged
    assert freed.stopped(Stop(5 * S, 2)).engaged


@given(st.integers(1, 200), st.integers(1, 200))
def test_it_stays_small_and_stopped_however_often_a_stop_is_said(count: int, again: int) -> None:
    record = StopRecord()
    for number in range(count):
        record = record.stopped(Stop(number * S, number + 1))
        if number % again == again - 1:
            record = record.freed()
    assert len(record.held) <= MOST_HELD
    assert len(record.released) <= MOST_RELEASED
    assert record.engaged == bool(count % again)


@given(histories)
def test_as_text_and_back(history: list[tuple[Any, ...]]) -> None:
    fleet = Fleet()
    fleet.play(history)
    for record in fleet.known:
        assert read_record(**record.texts()) == record


@pytest.mark.parametrize(
    "text", ["", "x", "1.", ".1", "-1.2", "1.2.3", "1e9.0", "9" * 400 + ".1", "²³.1", "1:2", "::."]
)
def test_what_makes_no_sense_is_left_out(text: str) -> None:
    assert read_record(text, text) == StopRecord()
    assert read_record(f"{text} 7.1", f"{text} 1:7.2").held == {Stop(7, 1)}


# ---------------------------------------------------------------- contradictions


def insisting(interval_s: float, count: int) -> Insistence:
    insistence = Insistence()
    for number in range(1, count + 1):
        insistence.hear([Stop(int(number * interval_s * S), number)], number * interval_s)
    return insistence


@pytest.mark.parametrize("interval_s", [0.01, 0.1, 1.0, 5.0])
def test_against_who_keeps_saying_stop_a_release_by_another_counts_for_nothing(interval_s: float) -> None:
    insistence, now_s = insisting(interval_s, 3), 3 * interval_s
    assert insistence.lasts(now_s + interval_s, 1)
    assert not insistence.lasts(now_s + 2 * interval_s + 0.6, 1)


def test_a_stop_that_is_pressed_twice_is_released_at_once() -> None:
    assert not insisting(0.3, 2).lasts(0.6, 1)


def test_stops_of_one_message_each_insist_on_nothing() -> None:
    insistence = Insistence()
    for number in range(9):
        insistence.hear([Stop(number * S, 1)], float(number))
    assert not insistence.lasts(9.0, 1)


def test_who_has_insisted_may_release_by_the_next_message() -> None:
    assert not insisting(0.1, 5).lasts(0.51, 6)


@pytest.mark.parametrize("order", list(permutations(["stop", "release"])))
@pytest.mark.parametrize("ahead", [0, 1, 2])
def test_two_who_contradict_each_other_at_one_rate_end_in_a_stop(order: tuple[str, str], ahead: int) -> None:
    insistence, obeyed = Insistence(), []
    for number in range(1, 30):
        now_s = number * 0.1
        for word in order:
            if word == "stop":
                insistence.hear([Stop(int(now_s * S), number)], now_s)
            else:
                obeyed.append(not insistence.lasts(now_s, number + ahead))
    assert not any(obeyed[5:])


def test_the_folder_of_a_stop(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    monkeypatch.setenv("DECK_STATE_DIR", str(tmp_path / "own"))
    assert stop_place(7) == tmp_path / "own/stops/7"
    monkeypatch.delenv("DECK_STATE_DIR")
    assert stop_place(7) == tmp_path / "state/deck/stops/7"
    monkeypatch.delenv("XDG_STATE_HOME")
    assert stop_place(7) == tmp_path / ".local/state/deck/stops/7"
