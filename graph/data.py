"""The ROS graph as plain data: what the observer hands over, without any rclpy objects.

Times are seconds on the monotonic clock unless a name says otherwise, sizes are bytes of the
serialized message (CDR), rates are messages per second.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from enum import Enum
from typing import TYPE_CHECKING, TypeAlias, Union

from text.ros_names import TF, TF_STATIC
from text.sentences import say

if TYPE_CHECKING:
    from concurrent.futures import Future

    # numpy takes a tenth of a second, and the screen's first frame needs none of it.
    import numpy as np
    from numpy.typing import NDArray

    from graph.inner_states import ContainerRow, LifecycleRow
    from space.buffer import Stamped

Value: TypeAlias = Union[
    bool, int, float, str, bytes, "NDArray[np.generic]", Sequence["Value"], Mapping[str, "Value"]
]
"""A message as a tree: messages are mappings in field order, `byte[]` and `uint8[]` are bytes,
other arrays of numbers are numpy arrays of shape (n,), arrays of anything else are lists.
A single `byte` is an int, 0..255."""

ANSWER_WITHIN_S = 5.0
"""Default time-out of a service call, and of each step of a goal: found, accepted, agreed to cancel, result."""


class Trouble(str, Enum):
    """Why a topic shows nothing. Four different causes, four different messages."""

    NO_PUBLISHER = "no publisher"
    QOS_MISMATCH = "qos mismatch"
    UNKNOWN_TYPE = "unknown type"
    QUIET = "quiet"
    """There are publishers, but nothing has arrived for longer than usual."""


PROCESS_NUMBERS = 1 << 16
"""The middleware reports the number of a process modulo this."""
NAMELESS = "_NODE_NAME_UNKNOWN_"
"""The name of a node that is not known yet, or of a program that is no node.

Source: rmw, `get_topic_endpoint_info.h`.
"""


@dataclass(frozen=True)
class EndpointInfo:
    """One publisher or subscription."""

    node: str
    """Full name of the node, with its namespace: `/sonar_front`."""
    type_name: str
    reliability: str
    """`reliable` or `best_effort`."""
    durability: str
    """`volatile` or `transient_local`."""
    depth: int = 0
    """0 if the peer does not report it, or keeps everything."""
    history: str = ""
    """`keep_last`, `keep_all`; empty if the peer does not report it."""
    deadline_s: float | None = None
    """None: none was requested or offered. The same holds for the next two."""
    lifespan_s: float | None = None
    lease_s: float | None = None
    liveliness: str = ""
    """`automatic`, `manual_by_topic`; empty if the peer does not report it."""
    process: int | None = field(default=None, compare=False)
    """Number of its process modulo `PROCESS_NUMBERS`; None if the middleware does not report it."""
    gid: bytes = field(default=b"", compare=False, repr=False)
    """What the middleware knows it by, in this process; empty outside of a live graph."""

    @property
    def is_named(self) -> bool:
        """Whether its node is known; names arrive a little later than endpoints."""
        return not self.node.endswith(NAMELESS)

    @property
    def called(self) -> str:
        """The name of its node for a reader, or a sentence that it is unknown."""
        return self.node if self.is_named else say("unknown node")


@dataclass(frozen=True)
class TopicRow:
    """One topic with its rates over the last seconds."""

    name: str
    type_names: tuple[str, ...]
    """`std_msgs/msg/Float32`; more than one if peers disagree."""
    publishers: int
    subscribers: int
    """Deck's own subscription is not counted."""
    hz: float | None = None
    """None while it is not measured or fewer than two messages have come."""
    bytes_per_s: float | None = None
    age_s: float | None = None
    """Since the newest message; None if none has come yet."""
    jitter_s: float | None = None
    """Standard deviation of the time between messages; None while too few have come."""
    latency_s: float | None = None
    """Mean of arrival time minus `header.stamp`; None without a header, or if the stamp is from
    another clock."""
    clock_off_s: float | None = None
    """Arrival time minus `header.stamp` of the newest message, if that is from another clock: a
    simulation, a board just booted. None otherwise, and while quiet."""
    several_send: bool = False
    """Whether the messages of the last seconds came from more than one publisher, as far as their
    sequence numbers show."""
    steady_hz: float | None = None
    """The rate at which messages came regularly until they stopped; None while they come."""
    lost: int | None = None
    """Messages that were sent but never arrived, since `measured`; None if the middleware does not
    report them."""
    count: int = 0
    """Messages taken since the subscription was made."""
    frame_id: str = ""
    """The frame that the header of the newest message names; empty without a header."""
    measured: bool = False
    """Whether Deck is subscribed now."""
    pictures_from: str = ""
    """The topic that its pictures are taken from, if that is another one."""
    trouble: Trouble | None = None
    detail: str = ""
    """What is wrong and what to do, where that takes more than the trouble itself; without one, a remark: peers that
    disagree about the type. Translatable words."""
    recorded: bool = False
    """Whether it is of a recording, which has no node to look at."""
    raw_from_afar: bool = False
    """Whether its raw pictures come over a network, so that silence may be loss."""
    published_by: tuple[EndpointInfo, ...] = ()
    subscribed_by: tuple[EndpointInfo, ...] = ()
    """Neither contains Deck's own endpoints."""
    own_publishers: int = 0
    """The number of Deck's own publishers."""
    from_afar: bool = False
    """Whether a publisher is on another machine, as far as the middleware tells."""


@dataclass(frozen=True)
class Sample:
    """A message decoded into plain data: mappings, lists, arrays of numpy, and scalars."""

    topic: str
    type_name: str
    received_s: float
    """When it was taken, unix time."""
    age_s: float
    """Time between its arrival at the middleware and being taken, if known, otherwise 0."""
    size_bytes: int
    value: Mapping[str, Value]
    sent_s: float | None = None
    """When its publisher handed it to the middleware, unix time by the publisher's clock; None
    if not reported. On one machine it orders messages of different topics better than their
    arrival does: the receiver is not always awake."""
    name: tuple[int, int] = (0, 0)
    """By which all who hear it know it: the time stamp of its publisher in nanoseconds, and the
    number of the message there. 0 for what the middleware does not tell."""


@dataclass(frozen=True)
class NodeRow:
    """One node of the graph."""

    name: str
    """Full name: `/sonar_front`."""
    publishes: tuple[str, ...] = ()
    subscribes: tuple[str, ...] = ()
    services: tuple[str, ...] = ()
    clients: tuple[str, ...] = ()
    """Services that it calls."""
    action_servers: tuple[str, ...] = ()
    action_clients: tuple[str, ...] = ()
    processes: tuple[int, ...] = ()
    """Numbers of its processes modulo `PROCESS_NUMBERS`: more than one if several nodes have the
    same name. Empty if the middleware does not report them."""


@dataclass(frozen=True)
class ServiceRow:
    """One service of the graph."""

    name: str
    type_names: tuple[str, ...]
    nodes: tuple[str, ...] = ()
    """Full names of the nodes that serve it."""
    called_as: tuple[str, ...] = ()
    """Types by which nodes call it that are not among `type_names`: they get no answer."""


@dataclass(frozen=True)
class ActionRow:
    """One action of the graph."""

    name: str
    type_names: tuple[str, ...]
    """`deck_interfaces/action/DriveToPoint`."""
    servers: tuple[str, ...] = ()
    """Full names of the nodes that serve it, and of those that call it."""
    clients: tuple[str, ...] = ()


@dataclass(frozen=True)
class FrameRow:
    """A frame in one of its parents, as somebody publishes it on /tf or /tf_static.

    A frame with two parents has two rows; so has one that is published on both topics.
    """

    newest: Stamped
    """Names are without a leading slash."""
    count: int
    """How many have come since Deck began to look."""
    hz: float | None = None
    """Per second; None for a static one, and while fewer than two have come."""
    age_s: float = 0.0
    """Since the newest arrived."""
    delay_s: float = 0.0
    """Arrival minus stamp of the newest: negative if the stamp is from the future."""
    publishers: tuple[str, ...] = ()
    """Full names of the nodes that publish it, or of those that may; once for each of one name."""
    certain: bool = True
    """Whether all of them do, as the messages told. Otherwise one of them does, perhaps more."""
    gone: str = ""
    """Full name of the node that published it last, if that is known and has gone."""
    fault: str = ""
    """Why one of the last seconds was not taken, a sentence: NaN, a quaternion of length 0, no
    name. `newest` is the one before it, or the identity."""
    faults: int = 0
    """How many were not taken, of all that have come."""
    slashed: bool = False
    """Whether somebody publishes it with a leading slash."""
    moved: bool = False
    """Whether a static one keeps changing, or comes from two nodes with different numbers."""
    contested: bool = False
    """Whether the numbers of the messages show that several publishers send it by turns."""

    @property
    def is_static(self) -> bool:
        """Whether it comes from /tf_static."""
        return self.newest.static


class GoalStatus(str, Enum):
    """The status of a goal (action_msgs/GoalStatus, and the states before it)."""

    SENDING = "sending"
    REJECTED = "rejected"
    ACCEPTED = "accepted"
    EXECUTING = "executing"
    CANCELING = "canceling"
    SUCCEEDED = "succeeded"
    CANCELED = "canceled"
    ABORTED = "aborted"
    FAILED = "failed"
    """There is no server, or it has gone or does not answer."""

    @property
    def ended(self) -> bool:
        """Whether nothing more is to come."""
        return self.value in {"rejected", "succeeded", "canceled", "aborted", "failed"}


@dataclass(frozen=True)
class Goal:
    """One goal sent by Deck."""

    number: int
    """Deck's own number, from 1."""
    action: str
    type_name: str
    status: GoalStatus
    goal: Mapping[str, Value]
    feedback: Mapping[str, Value] | None = None
    """The newest."""
    feedback_count: int = 0
    """How many came."""
    result: Mapping[str, Value] | None = None
    error: str = ""
    elapsed_s: float = 0.0
    """Since it was sent, or until it ended."""
    goal_id: str = ""
    """Identifies it to its server, 32 hexadecimal digits."""

    @property
    def ended(self) -> bool:
        """Whether nothing more is to come."""
        return self.status.ended


@dataclass(frozen=True)
class SeenGoal:
    """One goal sent by another client, as its server publishes it."""

    action: str
    type_name: str
    goal_id: str
    """32 hexadecimal digits."""
    status: GoalStatus
    age_s: float | None = None
    """Since its server accepted it, or until it was seen to end; None if Deck did not see that,
    or if the clocks do not agree."""
    feedback: Mapping[str, Value] | None = None
    """The newest."""
    feedback_count: int = 0
    """How many have come since Deck began to look."""
    error: str = ""

    @property
    def ended(self) -> bool:
        """Whether nothing more is to come."""
        return self.status.ended


@dataclass(frozen=True)
class Publication:
    """A message that Deck publishes periodically."""

    number: int
    """Deck's own number, from 1."""
    topic: str
    type_name: str
    hz: float
    sent: int
    subscribers: int
    error: str = ""
    """Why it stopped by itself."""


@dataclass(frozen=True)
class ParameterRow:
    """One parameter of a node, with its descriptor."""

    name: str
    type_name: str
    """`bool`, `integer`, `double`, `string`, `byte_array`, `bool_array`, `integer_array`,
    `double_array`, `string_array`, `not_set`."""
    value: Value | None
    description: str = ""
    constraints: str = ""
    """In the node's own words."""
    read_only: bool = False
    least: float | None = None
    greatest: float | None = None
    step: float | None = None
    """Step of its range; None without a range, or if any step is allowed."""


@dataclass(frozen=True)
class ParametersResult:
    """The parameters that a node reports, or why it does not."""

    node: str
    parameters: tuple[ParameterRow, ...] = ()
    error: str = ""
    elapsed_s: float = 0.0


@dataclass(frozen=True)
class SetResult:
    """The result of setting parameters: the reason for each refused one, or nothing."""

    node: str
    refused: Mapping[str, str] = field(default_factory=dict)
    error: str = ""
    """Why the result is unknown: no such node, no answer."""
    elapsed_s: float = 0.0


@dataclass(frozen=True)
class CallResult:
    """The end of a service call."""

    service: str
    ok: bool
    response: Mapping[str, Value] | None
    error: str
    """Why there is no response: no such service, time-out, unknown type, bad request."""
    elapsed_s: float
    late: Future[CallResult] | None = None
    """After a time-out: the late answer, if one comes."""


@dataclass(frozen=True)
class GraphUpdate:
    """Everything that changed since the previous update, handed over at the observer's rate."""

    time_s: float
    """Unix time of this update."""
    topics: tuple[TopicRow, ...] = ()
    """Every existing topic and every one that is watched or followed, sorted by name. A row that
    is the same object as in the previous update has not changed."""
    samples: Mapping[str, tuple[Sample, ...]] = field(default_factory=dict)
    """Topic to its new samples in order: one for a watched topic, all for a followed one."""
    nodes: tuple[NodeRow, ...] = ()
    services: tuple[ServiceRow, ...] = ()
    actions: tuple[ActionRow, ...] = ()
    goals: tuple[Goal, ...] = ()
    """Deck's own goals, oldest first; ended ones stay until they are forgotten."""
    seen_goals: tuple[SeenGoal, ...] = ()
    """Goals of other clients to the watched actions, as long as their servers list them."""
    publications: tuple[Publication, ...] = ()
    frames: tuple[FrameRow, ...] = ()
    """Every frame that has been heard of, sorted by name; empty unless frames are wanted."""
    lifecycles: tuple[LifecycleRow, ...] = ()
    """Every node with a lifecycle, sorted by name; empty unless inner states are wanted."""
    containers: tuple[ContainerRow, ...] = ()
    """Every container of components, likewise."""
    error: str = ""
    """Set when the observer cannot work at all: rclpy is missing, the domain is refused."""
    old_since_s: float | None = None
    """Unix time from which on nothing has been heard of the graph: the observer does not answer, or
    is being made anew. The rest is what was known then. None as a rule."""


@dataclass(frozen=True)
class Interest:
    """What somebody wants to see of the graph."""

    watched: frozenset[str] = frozenset()
    """Topics whose newest message each update has."""
    followed: frozenset[str] = frozenset()
    """Topics of which it has every message, up to 200 of each."""
    all_topics: bool = False
    """Whether the rates of all topics are measured, or only of those watched and followed."""
    actions: frozenset[str] = frozenset()
    """Actions whose goals are wanted, including other clients' goals."""
    inner_states: bool = False
    """Whether nodes are asked for their lifecycle, and containers for their components."""
    frames: bool = False
    """Whether the frames of /tf and /tf_static are wanted."""
    pictures: frozenset[str] = frozenset()
    """Topics of which the newest picture is wanted, from the topic that carries it cheapest: where the same pictures
    are offered compressed, samples are those of the topic asked for, and of another type."""
    all_images: bool = True
    """Whether `all_topics` includes those with pictures, as far as they come from this machine."""
    all_fast: bool = True
    """Whether it includes those that cost much to follow: fast ones, and large ones. Not while nobody looks: the rate
    of a fast one is known in a moment, that of a slow one is not."""
    period_s: float = 0.1
    """Seconds between two updates."""

    @property
    def named(self) -> frozenset[str]:
        """Topics that are wanted whether they exist or not."""
        named = self.watched | self.followed
        return named | {TF, TF_STATIC} if self.frames else named
