"""What goes between the screen and the observer's process, and when that is said to hang."""

from __future__ import annotations

import pickle
from dataclasses import replace
from multiprocessing import Pipe
from typing import Any, cast

import numpy as np
import pytest

from graph.data import EndpointInfo, GraphUpdate, NodeRow, Sample, TopicRow, Value
from graph.messages.making import NoSuchFieldError
from graph.messages.types import UnknownTypeError
from graph.observer.observer import GIVEN_UP_AFTER_S, HUNG_AFTER_S, ObserverProcess, _Line
from graph.observer.process import Speaker
from graph.observer.requests import ObserverError
from graph.observer.updates import KEPT_BYTES, news, renewed
from graph.ros import FAST_DDS, FAST_DDS_VARIABLES, RMW, announcing
from launcher.domain.discovery import settings_of_discovery
from tests.conftest import MIDDLEWARE
from tests.waiting import DEADLINE_S
from text.sentences import Words, say


def there_and_back(value: object) -> Any:
    return pickle.loads(pickle.dumps(value))


def test_errors_come_back_with_all_that_they_say() -> None:
    wrong = NoSuchFieldError("a.b", say("no such field; did you mean {name}?", name="c"))
    wrong.line = 3
    back = there_and_back(wrong)
    assert (type(back), back.field, back.message, back.line) == (NoSuchFieldError, "a.b", wrong.message, 3)
    unknown = there_and_back(UnknownTypeError(say("gone")))
    assert (type(unknown), unknown.words) == (UnknownTypeError, "gone")
    why = there_and_back(ObserverError(say("no: {why}", why=OSError("it is gone")))).words
    assert isinstance(why, Words)
    assert (why, why.template) == ("no: it is gone", "no: {why}")


def test_of_updates_only_what_has_changed_goes_over_and_they_come_back_whole() -> None:
    value: dict[str, Value] = {"a": 1, "b": np.arange(3), "c": b"\0" * 1000}
    ends = (EndpointInfo("/n", "a/msg/B", "reliable", "volatile"),)
    rows = (TopicRow("/t", ("a/msg/B",), 1, 0, published_by=ends), TopicRow("/u", (), 0, 0))
    first = GraphUpdate(1.0, rows, nodes=(NodeRow("/n"),))
    sample = Sample("/t", "a/msg/B", 1.0, 0.0, 10, value)
    second = replace(first, time_s=2.0, topics=(replace(rows[0], count=7), rows[1]), samples={"/t": (sample,)})
    third = replace(second, time_s=3.0, topics=(*second.topics, TopicRow("/v", (), 0, 1, subscribed_by=ends)))
    there = here = GraphUpdate(0.0)
    for update in (first, second, third):
        sent = pickle.dumps(news(update, here))
        there, here = renewed(there, pickle.loads(sent)), update
        assert (there.topics, there.nodes) == (update.topics, update.nodes)
        assert [one.size_bytes for one in there.samples.get("/t", ())] == [10] * len(update.samples)
        assert (b"reliable" in sent) == (update is not second), "endpoints, only if they are others"


class Silent:
    """As much of a process as is asked of it."""

    def __init__(self, *, ready: bool) -> None:
        self.is_ready_to_run = ready


@pytest.mark.parametrize(
    ("ready", "spoken", "after_s"),
    [(False, True, HUNG_AFTER_S), (True, True, GIVEN_UP_AFTER_S), (False, False, GIVEN_UP_AFTER_S)],
    ids=["at rest", "without a processor", "at its start"],
)
def test_one_that_could_run_and_does_not_hangs(ready: bool, spoken: bool, after_s: float) -> None:
    line = _Line(cast("ObserverProcess", Silent(ready=ready)), is_first=True, has_spoken=spoken)
    line.silent_s = after_s - 0.1
    assert not line.hangs()
    line.silent_s = after_s + 0.1
    assert line.hangs()


@pytest.fixture
def nothing_chosen(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in MIDDLEWARE:
        monkeypatch.delenv(name, raising=False)


@pytest.mark.usefixtures("nothing_chosen")
@pytest.mark.parametrize("discovery", ["localhost", "subnet", ("192.0.2.7",)])
@pytest.mark.parametrize("environ", [{}, {FAST_DDS_VARIABLES[0]: str(FAST_DDS)}, {RMW: "rmw_cyclonedds_cpp"}])
def test_it_is_found_as_the_nodes_of_a_session_are(
    discovery: str | tuple[str, ...], environ: dict[str, str], monkeypatch: pytest.MonkeyPatch
) -> None:
    for name, value in environ.items():
        monkeypatch.setenv(name, value)
    assert announcing(discovery) == settings_of_discovery(environ, discovery)


def test_a_reader_that_is_slow_gets_the_newest_and_lets_nothing_pile_up() -> None:
    ours, theirs = Pipe()
    speaker = Speaker(theirs)
    picture = Sample("/t", "a/msg/B", 1.0, 0.0, KEPT_BYTES // 2, {"data": b"x" * 1_000_000})
    for number in range(200):
        speaker.show(GraphUpdate(float(number), samples={"/t": (picture,)}))
        speaker.give_sign()
    speaker.say("an answer")
    heard: list[Any] = []
    while not heard or heard[-1].get("time_s") != 199.0:
        heard += [words for words in [ours.recv()] if isinstance(words, dict)]
    assert len(heard) <= 3
    assert sum(len(words["samples"].get("/t", ())) for words in heard) <= 2 * len(heard)
    speaker.finish(DEADLINE_S)
