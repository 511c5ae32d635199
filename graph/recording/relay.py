"""The relay: every message of a domain as it is, for a program that reads ROS messages itself."""

from __future__ import annotations

import atexit
import logging
import threading
import time
from typing import TYPE_CHECKING

from graph.recording.topics import RecordingTopics
from text.sentences import say

if TYPE_CHECKING:
    from graph.recording.topics import Sink, TopicChoice

logger = logging.getLogger(__name__)

TURN_S = 0.02
LOOK_S = 0.25
"""How often to empty the queues, and how often to look for new topics."""
STOP_WITHIN_S = 5.0


class Relay:
    """Hands on the topics of one domain from `start` to `stop`; it only listens."""

    def __init__(self, domain: int, discovery: str | tuple[str, ...], sink: Sink, choice: TopicChoice) -> None:
        """`sink` and what `choice` asks are called by the relay's own thread."""
        self.error = ""
        """Why nothing is handed on any more, as translatable words."""
        self._domain = domain
        self._discovery = discovery
        self._sink = sink
        self._choice = choice
        self._stopping = threading.Event()
        self._thread = threading.Thread(target=self._run, name="deck-relay", daemon=True)

    def start(self) -> None:
        # DDS threads must end before the interpreter does.
        atexit.register(self.stop)
        self._thread.start()

    def stop(self) -> None:
        """Leave the graph; returns within a few seconds."""
        self._stopping.set()
        atexit.unregister(self.stop)
        if self._thread.is_alive() and self._thread is not threading.current_thread():
            self._thread.join(STOP_WITHIN_S)

    def _run(self) -> None:
        try:
            # This imports rclpy; the caller need not wait for it.
            from graph.ros import open_ros

            ros = open_ros(self._domain, self._discovery, "view")
            try:
                self._take_turns(RecordingTopics(ros.node, self._choice, self._sink))
            finally:
                ros.close()
        except Exception as error:
            logger.exception("the relay failed")
            self.error = say("ROS cannot be used: {reason}", reason=error)

    def _take_turns(self, topics: RecordingTopics) -> None:
        look_at_s = 0.0
        while not self._stopping.wait(TURN_S):
            if time.monotonic() >= look_at_s:
                topics.look()
                look_at_s = time.monotonic() + LOOK_S
            if found := topics.drain():
                self._sink.put(found)
        topics.close()
