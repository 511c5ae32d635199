"""What can be asked of the observer from any thread, and the queue on which it goes to its own."""

from __future__ import annotations

import threading
import time
from collections import deque
from typing import TYPE_CHECKING, TypeVar

from graph.data import ParametersResult, SetResult
from graph.observer.orders import Ask, Call, Do, ObserverError, Order, Prepare, Publish, Urgent

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from concurrent.futures import Future

    from graph.data import CallResult, Value
    from graph.observer.station import Station
    from graph.publishing.dead_man_switch import Holding

T = TypeVar("T")


class Asking:
    """Takes orders on any thread and gives out futures; its observer carries the orders out."""

    def __init__(self) -> None:
        self._orders: deque[Order] = deque()
        self._urgent: deque[Urgent] = deque()
        self._lock = threading.Lock()
        self._wake = threading.Event()
        self._failure: ObserverError | None = None

    def prepare_publisher(
        self, topic: str, type_name: str, *, latched: bool = False
    ) -> Future[None]:
        """Make a publisher now, so that its first message goes out at once."""
        order = Prepare(topic, type_name, latched)
        self._order(order)
        return order.future

    def publish(
        self, topic: str, type_name: str, value: Mapping[str, Value], *, latched: bool = False
    ) -> Future[int]:
        """Publish one message; the future tells how many subscribers it went to.

        A new publisher waits up to a second for its subscribers, in the first seconds up to four.
        A latched message goes out at once and stays for those who come later; only the count
        waits. The future raises PublishError, UnknownTypeError, FieldError or
        ObserverError.
        """
        order = Publish(topic, type_name, value, latched)
        if latched:
            # An emergency stop is one of these.
            self._hurry(order, lambda station: station.outbox.knows_latched(topic, type_name))
        else:
            self._order(order)
        return order.future

    def call(
        self, service: str, type_name: str, request: Mapping[str, Value], timeout_s: float = 5.0
    ) -> Future[CallResult]:
        """Call a service; the result tells of an answer or why there is none, it never raises."""
        order = Call(service, type_name, request, timeout_s)
        self._order(order)
        return order.future

    def start_publishing(
        self, topic: str, type_name: str, value: Mapping[str, Value], hz: float
    ) -> Future[int]:
        """Publish a message at 0.1 to 100 Hz until it is stopped, or the observer is.

        The future tells its number; it raises PublishError, UnknownTypeError, FieldError or
        ObserverError.
        """
        order = Ask[int](
            lambda station, future: station.publications.start(
                topic, type_name, value, hz, station.ends(topic), future
            )
        )
        self._order(order)
        return order.future

    def stop_publishing(self, number: int) -> None:
        """Publish that one no more; updates do not tell of it any longer."""
        self._order(Do(lambda station: station.publications.stop(number)))

    def stop_publishing_all(self) -> None:
        """Publish nothing at a rate any more, not even what was asked for a moment ago."""
        order = Do(lambda station: station.publications.close())
        self._hurry(order, lambda _station: True)
        # What has been asked for and has not begun does so before this one's turn.
        self._order(order)

    def prepare_hold(self, topic: str, type_name: str) -> Future[None]:
        """Make a publisher for what may be held, and publish nothing.

        The future raises PublishError, UnknownTypeError or ObserverError.
        """

        def prepare(station: Station, future: Future[None]) -> None:
            station.held.prepare(topic, type_name, station.ends(topic))
            future.set_result(None)

        order = Ask[None](prepare)
        self._order(order)
        return order.future

    def hold(self, topic: str, type_name: str, word: Holding) -> Future[int]:
        """Publish a message again and again until `word.until_s`, unless asked again before.

        Then `word.rest` is published, and nothing more. The future tells how many subscribers are
        matched now; it raises PublishError, UnknownTypeError, FieldError or ObserverError.
        """

        def hold(station: Station, future: Future[int]) -> None:
            if not station.held.knows(topic):
                station.held.prepare(topic, type_name, station.ends(topic))
            future.set_result(station.held.hold(topic, word))

        order = Ask[int](hold)
        self._hurry(order, lambda station: station.held.knows(topic))
        return order.future

    def let_go(self, topic: str) -> None:
        """Publish the message of rest of what is held, at once."""
        self._hurry(Do(lambda station: station.held.let_go(topic)), lambda _station: True)

    def send_goal(self, action: str, type_name: str, goal: Mapping[str, Value]) -> Future[int]:
        """Send a goal; the future tells its number, and updates how it goes.

        It raises GoalError, UnknownTypeError, FieldError or ObserverError.
        """
        order = Ask[int](
            lambda station, future: station.goals.send(
                action, type_name, goal, station.action(action), future
            )
        )
        self._order(order)
        return order.future

    def cancel_goal(self, number: int) -> None:
        """Ask for a goal to be cancelled; updates tell whether its server agrees."""
        self._order(Do(lambda station: station.goals.cancel(number)))

    def cancel_seen_goal(self, action: str, goal_id: str) -> None:
        """Ask for a goal of somebody else's to be cancelled; updates tell what came of it."""
        self._order(Do(lambda station: station.seen_goals.cancel(action, goal_id)))

    def forget_goal(self, number: int) -> None:
        """Tell no more of a goal; one that has not ended is cancelled."""
        self._order(Do(lambda station: station.goals.forget(number)))

    def parameters(self, node: str, timeout_s: float = 5.0) -> Future[ParametersResult]:
        """Read all parameters of a node, with descriptors; `timeout_s` is for each answer.

        The result tells of them or why there are none, the future never raises.
        """
        asked_s = time.monotonic()
        order = Ask[ParametersResult](
            lambda station, future: station.parameters.read(node, timeout_s, asked_s, future),
            lambda error: ParametersResult(node, (), str(error), time.monotonic() - asked_s),
        )
        self._order(order)
        return order.future

    def set_parameters(
        self, node: str, values: Mapping[str, Value], timeout_s: float = 5.0
    ) -> Future[SetResult]:
        """Set parameters by the types that they have, each for itself.

        The result tells of each that was refused, and why; the future never raises.
        """
        asked_s = time.monotonic()
        order = Ask[SetResult](
            lambda station, future: station.parameters.write(
                node, values, timeout_s, asked_s, future
            ),
            lambda error: SetResult(node, {}, str(error), time.monotonic() - asked_s),
        )
        self._order(order)
        return order.future

    def _order(self, order: Order) -> None:
        self._put(self._orders, order, order)

    def _hurry(self, order: Order, ready: Callable[[Station], bool]) -> None:
        self._put(self._urgent, Urgent(order, ready), order)

    def _put(self, queue: deque[T], entry: T, order: Order) -> None:
        with self._lock:
            failure = self._failure
            if failure is None:
                queue.append(entry)
        if failure is not None:
            order.fail(failure)
        self._wake.set()

    def _carry_out_orders(self, station: Station) -> None:
        while self._urgent or self._orders:
            order = self._urgent.popleft().order if self._urgent else self._orders.popleft()
            _carry_out(order, station)

    def _breathe(self, station: Station) -> None:
        """Do what cannot wait for the end of a look: stops, and what is held."""
        while self._urgent and self._urgent[0].ready(station):
            _carry_out(self._urgent.popleft().order, station)
        station.held.step()

    def _refuse_orders(self, failure: ObserverError) -> None:
        with self._lock:
            self._failure = failure
        while self._urgent:
            self._urgent.popleft().order.fail(failure)
        while self._orders:
            self._orders.popleft().fail(failure)


def _carry_out(order: Order, station: Station) -> None:
    try:
        order.carry_out(station)
    except Exception as error:  # noqa: BLE001 - told to whoever asked for it
        order.fail(error)
