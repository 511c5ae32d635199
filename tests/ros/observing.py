"""Real ROS nodes in processes of their own, and an observer that looks at them."""

from __future__ import annotations

import json
import os
import queue
import threading
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

from graph.data import GraphUpdate, NodeRow, Sample, TopicRow
from graph.observer.observer import Observer, ObserverProcess
from graph.ros import FAST_DDS, FAST_DDS_VARIABLES
from tests.ros.observer_thread import ObserverThread
from tests.slowness import patient
from tests.waiting import DEADLINE_S, wait_until
from tests.warm_program import PIPE, WarmProgram

ROOT = Path(__file__).parents[2]


class Peer:
    """A node in a process of its own; `peer.advertise(...)` has it do `Orders.advertise`."""

    def __init__(self, name: str, domain: int, *options: str, fast_dds: Path = FAST_DDS) -> None:
        self.name = f"/{name}"
        self.action = ""
        """For tests that share it: the action of the one that runs."""
        self.heard: dict[str, list[str]] = {}
        self.served: list[str] = []
        self._answers: queue.Queue[Any] = queue.Queue()
        self.process = WarmProgram(
            ("tests.ros.told_node", name, *options),
            cwd=str(ROOT),
            env={
                **os.environ,
                "ROS_DOMAIN_ID": str(domain),
                "ROS_AUTOMATIC_DISCOVERY_RANGE": "SYSTEM_DEFAULT",
                # As Deck's own processes have it: found in tenths of a second, not in three.
                FAST_DDS_VARIABLES[0]: str(fast_dds),
            },
            stdin=PIPE,
            stderr=2,
        )
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()
        self._answers.get(timeout=patient(DEADLINE_S))

    def __getattr__(self, order: str) -> Any:
        def do(topic: str = "", /, **words: Any) -> Any:
            words = {"topic": topic, **words} if topic else words
            assert self.process.stdin is not None
            self.process.stdin.write(json.dumps({"order": order, **words}) + "\n")
            self.process.stdin.flush()
            return self._answers.get(timeout=patient(DEADLINE_S))

        return do

    def kill(self) -> None:
        self.process.kill()
        self.process.wait(10)

    def close(self) -> None:
        assert self.process.stdin is not None
        self.process.stdin.close()
        self.process.wait(10)
        self._reader.join(10)
        assert self.process.stdout is not None
        self.process.stdout.close()

    def _read(self) -> None:
        assert self.process.stdout is not None
        for line in self.process.stdout:
            if not line.startswith("{"):
                # Fast DDS has a word to say, on stdout.
                print(line, end="")  # noqa: T201 - into the report of a test that fails
                continue
            said = json.loads(line)
            if "heard" in said:
                self.heard.setdefault(said["heard"], []).append(said["value"])
            elif "served" in said:
                self.served.append(said["served"])
            else:
                self._answers.put(said.get("done"))


class Watcher:
    """An observer and all that it has handed over.

    `apart`: starts a process of its own, as everywhere but here.
    """

    def __init__(
        self, domain: int, *, apart: Callable[[], ObserverProcess] = ObserverThread, **settings: Any
    ) -> None:
        self.observer = Observer(domain, "localhost", **settings)
        self.observer.start_process = apart
        self.update = GraphUpdate(0.0)
        self.updates = 0
        self.samples: dict[str, list[Sample]] = {}
        self.observer.start(self._take)

    def want(self, **changes: Any) -> None:
        """Have this changed of what is wanted; lists of names may be of any kind."""
        told: dict[str, Any] = {
            name: frozenset(one) if not isinstance(one, (bool, float)) else one for name, one in changes.items()
        }
        self.observer.want(replace(self.observer.wanted, **told))

    def row(self, topic: str) -> TopicRow | None:
        return next((row for row in self.update.topics if row.name == topic), None)

    def node(self, name: str) -> NodeRow | None:
        return next((row for row in self.update.nodes if row.name == name), None)

    def serves(self, name: str) -> bool:
        return any(row.name == name for row in self.update.services)

    def of(self, topic: str) -> list[Any]:
        """The values of the samples so far; `data` alone where that is all there is."""
        return [s.value["data"] if len(s.value) == 1 else s.value for s in self.samples.get(topic, [])]

    def wait_for(self, topic: str, test: Any, what: str) -> TopicRow:
        """Wait until the topic's row is there and passes the test, and its nodes are known.

        An endpoint is found a little before the name of its node.
        """

        def passes() -> TopicRow | None:
            row = self.row(topic)
            return row if row and _all_named(row) and test(row) else None

        return wait_until(passes, f"{topic}: {what}")

    def close(self) -> None:
        self.want(watched=())
        self.observer.stop()

    def _take(self, update: GraphUpdate) -> None:
        for topic, samples in update.samples.items():
            self.samples.setdefault(topic, []).extend(samples)
        self.update = update
        self.updates += 1


def _all_named(row: TopicRow) -> bool:
    ends = (*row.published_by, *row.subscribed_by)
    return all(end.is_named for end in ends)


def let_updates_come(watcher: Watcher, count: int) -> None:
    """Wait until so many more updates have come: what would have shown up has had its time."""
    goal = watcher.updates + count
    wait_until(lambda: watcher.updates >= goal, f"{count} more updates")
