"""What is published, for Foxglove: a WebSocket server on this machine, which hands on raw messages.

Clients only look. The server has none of the capabilities by which they could publish, call a
service or set parameters, so nobody who reaches it can drive the robot.
"""

from __future__ import annotations

import threading
from collections import deque
from typing import TYPE_CHECKING, Any

from graph.heavy_types import HEAVY_TYPES
from graph.housekeeping import is_hidden
from graph.pictures.source import THINNED
from graph.qos import TRANSIENT_LOCAL
from graph.recording.topics import Relay, TopicChoice
from text.sentences import reason_of, say
from view.place import FOXGLOVE_PORT, HERE, ViewError, free_port, need_foxglove

if TYPE_CHECKING:
    from collections.abc import Sequence

    from typing_extensions import Self

    from graph.recording.writer import BagTopic, Message

NAME = "Deck"
LOOK_S = 0.1
BACKLOG = 256
"""Messages that wait for a slow client; the oldest are dropped."""
LATCHED = 50
"""Messages kept of a latched topic, for clients that come later."""


class _Channels:
    """A channel of the server for every topic; messages come from one thread."""

    def __init__(self) -> None:
        self._channels: dict[str, Any] = {}
        self._kept: dict[str, deque[Message]] = {}
        self._asked: set[str] = set()
        """Latched topics that a client has just asked for."""
        self._lock = threading.Lock()

    def add_topic(self, topic: BagTopic, text: str) -> None:
        import foxglove

        if is_latched(topic):
            with self._lock:
                self._kept[topic.name] = deque(maxlen=LATCHED)
        schema = foxglove.Schema(name=topic.type_name, encoding="ros2msg", data=text.encode())
        channel = foxglove.Channel(topic.name, schema=schema, message_encoding="cdr")
        with self._lock:
            self._channels[topic.name] = channel

    def put(self, messages: Sequence[Message]) -> None:
        for message in messages:
            name = message.topic.name
            with self._lock:
                channel = self._channels[name]
                if name in self._kept:
                    self._kept[name].append(message)
            if channel.has_sinks():
                channel.log(message.raw, log_time=message.stamp_ns)

    def are_asked_for(self, topic: BagTopic) -> bool:
        """Whether to take the messages of a topic: pictures and clouds only while a client listens.

        They are megabytes, over a network too. What is latched is kept for whoever comes.
        """
        if topic.type_name not in HEAVY_TYPES or is_latched(topic):
            return True
        with self._lock:
            channel = self._channels.get(topic.name)
        return channel is not None and bool(channel.has_sinks())

    def ask_for(self, topic: str) -> None:
        """Note that a client begins to listen to a topic; called by the server's thread."""
        with self._lock:
            if topic in self._kept:
                self._asked.add(topic)

    def repeat(self) -> None:
        """Say again what was said on latched topics before somebody began to listen.

        Those who listen already hear it again, since the server has no way to tell one of them
        alone. The channel does not know a client yet when its wish is heard of: hence not at once.
        """
        with self._lock:
            ready = {topic for topic in self._asked if self._is_heard(topic)}
            self._asked -= ready
            again = [(self._channels[topic], list(self._kept[topic])) for topic in ready]
        for channel, messages in again:
            for message in messages:
                channel.log(message.raw, log_time=message.stamp_ns)

    def _is_heard(self, topic: str) -> bool:
        return topic in self._channels and bool(self._channels[topic].has_sinks())


class Sharing:
    """The server and what feeds it; open it, wait, close it."""

    def __init__(self, domain: int, discovery: str | tuple[str, ...], port: int | None = None) -> None:
        """Serve at `port`, near the usual one if there is none. Raises ViewError."""
        need_foxglove()
        import foxglove

        self.port = free_port(FOXGLOVE_PORT, port)
        self._channels = channels = _Channels()
        try:
            self._server = foxglove.start_server(
                name=NAME,
                host=HERE,
                port=self.port,
                capabilities=[],
                server_listener=_listener(channels),
                message_backlog_size=BACKLOG,
            )
        except Exception as error:
            raise ViewError(
                say("The server for Foxglove does not start: {reason}", reason=reason_of(error))
            ) from error
        choice = TopicChoice(wanted=_is_shared, asked_for=channels.are_asked_for)
        self._relay = Relay(domain, discovery, channels, choice)
        self._relay.start()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._relay.stop()
        self._server.stop()

    @property
    def url(self) -> str:
        return f"ws://{HERE}:{self.port}"

    def wait(self, stop: threading.Event) -> None:
        """Wait until it is stopped. Raises ViewError if it broke."""
        while not stop.wait(LOOK_S):
            if self._relay.error:
                raise ViewError(self._relay.error)
            self._channels.repeat()


def is_latched(topic: BagTopic) -> bool:
    """Whether anybody latches what is published there."""
    return any(offer["durability"] == TRANSIENT_LOCAL for offer in topic.offers)


def _is_shared(name: str, types: Sequence[str]) -> bool:
    """Return whether a topic is handed on: what is not hidden, and small pictures of cameras."""
    del types
    return not is_hidden(name) or name.endswith(THINNED)


def _listener(channels: _Channels) -> Any:  # noqa: ANN401
    from foxglove.websocket import ServerListener

    class Listener(ServerListener):  # type: ignore[misc]
        """Tells the channels who begins to listen."""

        def on_subscribe(self, client: Any, channel: Any) -> None:  # noqa: ANN401
            del client
            channels.ask_for(channel.topic)

    return Listener()
