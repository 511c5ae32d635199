"""What the graph is asked for: a class a request, with its answer and what the observer does for it.

A request is plain data, which goes to the observer's process and is begun there. Names and values are those of ROS:
full names of topics, services, actions and nodes, types like `std_msgs/msg/Bool`, messages as trees of values.
"""

from __future__ import annotations

import math
from concurrent.futures import Future, InvalidStateError
from contextlib import suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Generic, NamedTuple, TypeVar

from graph.data import ANSWER_WITHIN_S, CallResult, ParametersResult, SetResult
from graph.inner_states import LevelResult, TransitionResult
from text.sentences import SaidError, reason_of

if TYPE_CHECKING:
    from collections.abc import Mapping

    from graph.data import Value
    from graph.observer.node import ObserverNode
    from graph.publishing.dead_man_switch import HeldCommand

LATE_S = 5.0
"""What was asked for so long ago is not done: it was meant for another moment, and could drive the robot."""
WITHDRAWN_LATE_S = 0.5
"""The same for a latched `false`: it would take back what somebody has said since."""

T = TypeVar("T")


class ObserverError(SaidError):
    """The observer cannot work, or has been stopped; `words` says why."""


@dataclass(frozen=True)
class Request(Generic[T]):
    """Something that the graph is asked for and that is answered by a T."""

    @property
    def late_s(self) -> float:
        """How long after it was asked for it is still begun, in seconds."""
        return LATE_S

    @property
    def lasts(self) -> bool:
        """Whether another process is asked for it if this one ends: nothing moves by it, or it is a stop."""
        return False

    @property
    def hurries(self) -> bool:
        """Whether it comes before all others."""
        return False

    @property
    def in_turn_too(self) -> bool:
        """Whether one that hurries is done again in its turn: what was asked for before it may not have begun yet."""
        return False

    def is_ready(self, node: ObserverNode) -> bool:
        """Return whether one that hurries may interrupt a look at the graph, as it does not need one itself."""
        del node
        return True

    def begin(self, node: ObserverNode, future: Future[T]) -> None:
        """Begin it in the observer's loop; the future gets the answer. May raise anything."""
        future.set_result(self.do(node))

    def do(self, node: ObserverNode) -> T:
        """Do it, where that takes no time. May raise anything."""
        raise NotImplementedError

    def refused(self, error: Exception, elapsed_s: float = 0.0) -> T:
        """Return the answer that says why not; raise `error` if no answer can say that."""
        del elapsed_s
        raise error


def refuse(request: Request[T], future: Future[T], error: Exception, elapsed_s: float = 0.0) -> None:
    """Say to whoever waits for the answer why there is none."""
    with suppress(InvalidStateError):
        try:
            future.set_result(request.refused(error, elapsed_s))
        except Exception as refusal:  # noqa: BLE001 - that is the answer
            future.set_exception(refusal)


@dataclass(frozen=True)
class Opening:
    """What the process is told first: where to observe, and how."""

    domain: int
    discovery: str | tuple[str, ...] = "localhost"
    """`localhost`, `subnet`, or the addresses of peers."""
    graph_s: float = 0.25
    """Seconds between two looks at who is there."""
    role: str = "observer"
    """Part of its node's name, see `graph.ros.ONLY_LISTENING`."""
    owner: int = 0
    """The process that it is for, by whose number its node is called; 0 for its own."""
    first_number: int = 1
    """Of its goals and publications: those of a process before it had others."""


class Order(NamedTuple):
    """A request on its way; its answer has the same number."""

    number: int
    request: Request[Any]
    asked_s: float
    """On the monotonic clock, which all processes of a machine share."""


class Answer(NamedTuple):
    """An answer, or why there is none."""

    number: int
    result: Any = None
    error: Exception | None = None
    is_first: bool = False
    """Whether it says that the time is over, and another with the same number may follow."""


# ---------------------------------------------------------------- publishing


@dataclass(frozen=True)
class PreparePublisher(Request[None]):
    """Create a publisher now, so that its first message goes out at once.

    Raises PublishError, UnknownTypeError or ObserverError, as do all that publish.
    """

    topic: str
    type_name: str
    latched: bool = False
    late_s = math.inf
    lasts = True

    def do(self, node: ObserverNode) -> None:
        node.outbox.prepare(self.topic, self.type_name, node.ends(self.topic), latched=self.latched)


@dataclass(frozen=True)
class Publish(Request[int]):
    """Publish one message, and answer how many subscribers it went to.

    A new publisher waits up to a second for its subscribers, or up to four seconds just after the start. A latched
    message goes out at once and stays for late subscribers; only the count waits. Raises FieldError as well.
    """

    topic: str
    type_name: str
    value: Mapping[str, Value]
    latched: bool = False

    @property
    def late_s(self) -> float:
        if self.lasts:
            return math.inf
        return WITHDRAWN_LATE_S if self.latched else LATE_S

    @property
    def lasts(self) -> bool:
        """Whether it holds however often it is said: a latched message, such as a stop, but no release."""
        return self.latched and self.value != {"data": False}

    @property
    def hurries(self) -> bool:
        """Whether it may be an emergency stop."""
        return self.latched

    def is_ready(self, node: ObserverNode) -> bool:
        return node.outbox.knows_latched(self.topic, self.type_name)

    def begin(self, node: ObserverNode, future: Future[int]) -> None:
        # An emergency stop must not wait for a look at the graph, which takes its time.
        ends = None if self.latched and self.is_ready(node) else node.ends(self.topic)
        node.outbox.publish(self.topic, self.type_name, self.value, ends, future, latched=self.latched)


@dataclass(frozen=True)
class StartPublishing(Request[int]):
    """Publish a message at 0.1 to 100 Hz until this, or the observer, is stopped; answer its number.

    Raises FieldError as well.
    """

    topic: str
    type_name: str
    value: Mapping[str, Value]
    hz: float

    def do(self, node: ObserverNode) -> int:
        ends = node.ends(self.topic)
        return node.publications.start(self.topic, self.type_name, self.value, self.hz, ends)


@dataclass(frozen=True)
class PrepareHold(Request[None]):
    """Create a publisher for `Hold`, and publish nothing."""

    topic: str
    type_name: str
    late_s = math.inf
    lasts = True

    def do(self, node: ObserverNode) -> None:
        node.dead_man_switch.prepare(self.topic, self.type_name, node.ends(self.topic))


@dataclass(frozen=True)
class Hold(Request[int]):
    """Publish a message repeatedly until `command.until_s`, unless asked again before that; then `command.rest`.

    Answers how many subscribers are matched now. Raises FieldError as well.
    """

    topic: str
    type_name: str
    command: HeldCommand
    hurries = True

    def is_ready(self, node: ObserverNode) -> bool:
        return node.dead_man_switch.knows(self.topic)

    def do(self, node: ObserverNode) -> int:
        if not self.is_ready(node):
            node.dead_man_switch.prepare(self.topic, self.type_name, node.ends(self.topic))
        return node.dead_man_switch.hold(self.topic, self.command)


# ---------------------------------------------------------------- ending


@dataclass(frozen=True)
class Ending(Request[None]):
    """What ends something: it is never too late, and where there is nothing to end it is done already."""

    late_s = math.inf

    def refused(self, error: Exception, elapsed_s: float = 0.0) -> None:
        """Do nothing: its subject has ended with the observer."""


@dataclass(frozen=True)
class TakeBack(Ending):
    """Let a latched message, once published, reach no later subscriber."""

    topic: str
    type_name: str

    def do(self, node: ObserverNode) -> None:
        node.outbox.renew_latched(self.topic, self.type_name, node.ends(self.topic))


@dataclass(frozen=True)
class StopPublishing(Ending):
    """Stop this publication; updates no longer report it."""

    number: int

    def do(self, node: ObserverNode) -> None:
        node.publications.stop(self.number)


@dataclass(frozen=True)
class StopPublishingAll(Ending):
    """Stop all periodic publications, even those asked for a moment ago."""

    hurries = in_turn_too = True

    def do(self, node: ObserverNode) -> None:
        node.publications.close()


@dataclass(frozen=True)
class StopCommanding(StopPublishingAll):
    """Release what is held, stop all periodic publications and cancel all goals."""

    def do(self, node: ObserverNode) -> None:
        node.stop_commanding()


@dataclass(frozen=True)
class LetGo(Ending):
    """Publish the rest message of a held topic at once."""

    topic: str
    hurries = True

    def do(self, node: ObserverNode) -> None:
        node.dead_man_switch.let_go(self.topic)


@dataclass(frozen=True)
class CancelGoal(Ending):
    """Ask for a goal of Deck's to be cancelled; updates report whether its server agrees."""

    number: int

    def do(self, node: ObserverNode) -> None:
        node.goals.cancel(self.number)


@dataclass(frozen=True)
class ForgetGoal(Ending):
    """Stop reporting a goal of Deck's; one that has not ended is cancelled."""

    number: int

    def do(self, node: ObserverNode) -> None:
        node.goals.forget(self.number)


@dataclass(frozen=True)
class CancelSeenGoal(Ending):
    """Ask for another client's goal to be cancelled; updates report the outcome."""

    action: str
    goal_id: str
    type_name: str = ""
    """If it is known: then it is asked for whether anything is known of the goal or not."""

    def do(self, node: ObserverNode) -> None:
        node.seen_goals.cancel(self.action, self.goal_id, self.type_name)


# ---------------------------------------------------------------- asking others


@dataclass(frozen=True)
class SendGoal(Request[int]):
    """Send a goal, and answer its number; updates report its progress.

    Raises GoalError, UnknownTypeError, FieldError or ObserverError.
    """

    action: str
    type_name: str
    goal: Mapping[str, Value]

    def do(self, node: ObserverNode) -> int:
        return node.goals.send(self.action, self.type_name, self.goal, node.action(self.action))


@dataclass(frozen=True)
class CallService(Request[CallResult]):
    """Call a service; the result holds the answer or the failure, and this and those below never raise."""

    service: str
    type_name: str
    request: Mapping[str, Value]
    timeout_s: float = ANSWER_WITHIN_S

    def begin(self, node: ObserverNode, future: Future[CallResult]) -> None:
        known = node.service(self.service)
        node.calls.begin(self.service, self.type_name, self.request, known, future, self.timeout_s)

    def refused(self, error: Exception, elapsed_s: float = 0.0) -> CallResult:
        return CallResult(self.service, False, None, reason_of(error), elapsed_s)


@dataclass(frozen=True)
class ReadParameters(Request[ParametersResult]):
    """Read all parameters of a node, with descriptors; `timeout_s` is for each answer."""

    node: str
    timeout_s: float = ANSWER_WITHIN_S

    def begin(self, node: ObserverNode, future: Future[ParametersResult]) -> None:
        node.parameters.read(self.node, self.timeout_s, future)

    def refused(self, error: Exception, elapsed_s: float = 0.0) -> ParametersResult:
        return ParametersResult(self.node, (), reason_of(error), elapsed_s)


@dataclass(frozen=True)
class SetParameters(Request[SetResult]):
    """Set parameters, keeping their types, each independently; the result lists those that were refused, and why."""

    node: str
    values: Mapping[str, Value]
    timeout_s: float = ANSWER_WITHIN_S

    def begin(self, node: ObserverNode, future: Future[SetResult]) -> None:
        node.parameters.write(self.node, self.values, self.timeout_s, future)

    def refused(self, error: Exception, elapsed_s: float = 0.0) -> SetResult:
        return SetResult(self.node, {}, reason_of(error), elapsed_s)


@dataclass(frozen=True)
class ChangeState(Request[TransitionResult]):
    """Have a node with a lifecycle make a transition, by its name: `configure`.

    The result says what it led to, or in words why not. The transition itself may take longer than other answers.
    """

    node: str
    transition: str

    def begin(self, node: ObserverNode, future: Future[TransitionResult]) -> None:
        node.lifecycles.change(self.node, self.transition, future)

    def refused(self, error: Exception, elapsed_s: float = 0.0) -> TransitionResult:
        del elapsed_s
        return TransitionResult(self.node, self.transition, error=reason_of(error))


@dataclass(frozen=True)
class LogLevel(Request[LevelResult]):
    """Read from which severity on a node logs, or set it to one of `graph.inner_states.LOG_LEVELS` first."""

    node: str
    level: str | None = None

    def begin(self, node: ObserverNode, future: Future[LevelResult]) -> None:
        node.logger_levels.ask(self.node, self.level, future)

    def refused(self, error: Exception, elapsed_s: float = 0.0) -> LevelResult:
        del elapsed_s
        return LevelResult(self.node, error=reason_of(error))
