"""The action of lesson 3, asked by a real action client: reached, cancelled, refused, given up."""

from __future__ import annotations

import math
import signal
from typing import TYPE_CHECKING, Any

import pytest
from ackermann_msgs.msg import AckermannDriveStamped
from action_msgs.msg import GoalStatus
from deck_interfaces.action import DriveToPoint
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import Odometry
from rclpy.action import ActionClient
from std_msgs.msg import Bool
from tf2_msgs.msg import TFMessage

from tests.ros.node_process import NodeProcess
from tests.ros.node_thread import NodeThread
from tests.ros.peer import LATCHED, Peer
from tests.waiting import wait_until

if TYPE_CHECKING:
    from collections.abc import Callable

    from rclpy.task import Future

MODULE = "nodes.drive_to_point"
SIMULATED: dict[str, object] = {"simulate": "always", "max_speed": 0.5, "stale_after_s": 20.0, "patience_s": 60.0}
"""A busy machine that stands for some seconds shall end no drive."""
SUCCEEDED, CANCELED, ABORTED = (GoalStatus.STATUS_SUCCEEDED, GoalStatus.STATUS_CANCELED, GoalStatus.STATUS_ABORTED)


class Asker:
    """A client of the action."""

    def __init__(self, peer: Peer) -> None:
        self._peer = peer
        self._client = ActionClient(peer.node, DriveToPoint, "drive_to_point")
        wait_until(self._client.server_is_ready, "the action server")
        self.feedback: list[float] = []
        self.handle: Any = None

    def ask(self, x: float, y: float, tolerance: float = 0.0) -> bool:
        goal = DriveToPoint.Goal(x=x, y=y, tolerance=tolerance)
        self.feedback.clear()

        def send() -> Future:
            sent: Future = self._client.send_goal_async(
                goal, feedback_callback=lambda told: self.feedback.append(told.feedback.distance)
            )
            return sent

        self.handle = self._peer.insist(
            lambda: self._peer.on_its_thread(send, "a goal on its way"), "an answer to the goal"
        )
        return bool(self.handle.accepted)

    def result(self) -> Future:
        """Ask for the result, which comes when the goal has ended."""
        handle = self.handle

        def ask() -> Future:
            asked: Future = handle.get_result_async()
            return asked

        return self._peer.on_its_thread(ask, "a question for the result")

    def end(self) -> tuple[int, DriveToPoint.Result]:
        """Wait for the end; the status and the result."""
        ended = self._peer.answer(self.result(), "a result")
        return ended.status, ended.result

    def cancel(self) -> None:
        """Ask to cancel, and wait until that is granted."""
        answer = self._answer(self.handle.cancel_goal_async, "an answer to the cancellation")
        assert answer.goals_canceling

    def _answer(self, call: Callable[[], Future], what: str) -> Any:
        return self._peer.answer(self._peer.on_its_thread(call, what), what)


def odometry(x: float = 0.0, y: float = 0.0) -> Odometry:
    message = Odometry()
    message.pose.pose.position.x, message.pose.pose.position.y = x, y
    message.pose.pose.orientation.w = 1.0
    return message


def off_m(pose: Odometry, x: float, y: float) -> float:
    """Return the distance of a pose from a point."""
    return math.dist((pose.pose.pose.position.x, pose.pose.pose.position.y), (x, y))


def wait_for_motion(heard: list[AckermannDriveStamped]) -> None:
    wait_until(lambda: any(message.drive.speed for message in heard), "motion on /drive")


def wait_for_stop(heard: list[AckermannDriveStamped]) -> None:
    wait_until(lambda: heard and heard[-1].drive.speed == 0.0, "a stop on /drive")


# ---------------------------------------------------------------- it drives


def test_it_reaches_the_point_while_the_distance_falls(peer: Peer, ros_domain: int) -> None:
    with NodeThread(MODULE, ros_domain, params=SIMULATED) as node:
        drive = peer.hear("/drive", AckermannDriveStamped)
        poses, transforms = peer.hear("/odom", Odometry), peer.hear("/tf", TFMessage)
        goals = peer.hear("/goal_pose", PoseStamped, LATCHED)
        asker = Asker(peer)
        assert asker.ask(0.8, 0.2, 0.05)
        wait_until(lambda: goals, "the goal")
        assert goals[0].header.frame_id == "odom"
        assert (goals[0].pose.position.x, goals[0].pose.position.y) == (0.8, 0.2)
        status, result = asker.end()
        wait_until(lambda: goals[-1].header.frame_id == "", "the end of the goal")
        assert (status, result.reached) == (SUCCEEDED, True)
        assert result.distance <= 0.05
        assert "Arrived" in result.message
        assert len(asker.feedback) >= 3
        assert asker.feedback == sorted(asker.feedback, reverse=True)
        wait_for_stop(drive)
        assert max(message.drive.speed for message in drive) <= 0.5
        wait_until(lambda: off_m(poses[-1], 0.8, 0.2) <= 0.06, "the pose at the point")
        assert poses[-1].header.frame_id == "odom"
        assert transforms[-1].transforms[0].child_frame_id == "base_link"
        node.wait_for_words("Driving to x 0.80, y 0.20 m, to within 0.05 m", "Arrived: ")


# ---------------------------------------------------------------- it gives up


def test_a_cancelled_drive_stops(peer: Peer, ros_domain: int) -> None:
    with NodeThread(MODULE, ros_domain, params=SIMULATED):
        drive = peer.hear("/drive", AckermannDriveStamped)
        asker = Asker(peer)
        assert asker.ask(9.0, 0.0)
        wait_for_motion(drive)
        asker.cancel()
        status, result = asker.end()
        assert (status, result.reached) == (CANCELED, False)
        assert result.distance > 1
        assert "Cancelled" in result.message
        wait_for_stop(drive)


@pytest.mark.parametrize("qos", [LATCHED, 10], ids=["latched", "volatile"])
def test_the_emergency_stop_ends_a_drive_and_holds(peer: Peer, ros_domain: int, qos: Any) -> None:
    with NodeThread(MODULE, ros_domain, params=SIMULATED) as node:
        drive = peer.hear("/drive", AckermannDriveStamped)
        poses = peer.hear("/odom", Odometry)
        asker = Asker(peer)
        assert asker.ask(9.0, 0.0)
        wait_for_motion(drive)
        peer.say("/emergency_stop", Bool(data=True), qos=qos)
        status, result = asker.end()
        assert (status, result.message[:14]) == (ABORTED, "Emergency stop")
        wait_for_stop(drive)
        assert not asker.ask(1.0, 0.0)
        node.wait_for_words("Refused: the emergency stop is held")
        wait_until(lambda: poses[-1].twist.twist.linear.x == 0.0, "a base that stands")
        peer.say("/emergency_stop", Bool(data=False), qos=qos)
        node.wait_for_words("waiting for a new goal")
        assert asker.ask(poses[-1].pose.pose.position.x, 0.0)
        assert asker.end()[0] == SUCCEEDED


def test_odometry_that_falls_silent_or_is_no_number_ends_a_drive(peer: Peer, ros_domain: int) -> None:
    params: dict[str, object] = {"simulate": "never", "stale_after_s": 0.5}
    with NodeThread(MODULE, ros_domain, params=params) as node:
        drive = peer.hear("/drive", AckermannDriveStamped)
        asker = Asker(peer)
        # Heard as best effort: what is said before both sides know of each other is lost.
        with peer.saying("/odom", odometry()):
            assert asker.ask(1.0, 0.0)
            wait_for_motion(drive)
        with peer.saying("/odom", odometry(math.nan)):
            status, result = asker.end()
            assert status == ABORTED
            assert "No /odom for 0.5 s, 1.00 m from the point" in result.message
            wait_for_stop(drive)
            node.wait_for_words("/odom is not a number")


# ---------------------------------------------------------------- it refuses


def test_goals_that_make_no_sense_are_refused_with_a_word(peer: Peer, ros_domain: int) -> None:
    with NodeThread(MODULE, ros_domain, params=SIMULATED) as node:
        drive = peer.hear("/drive", AckermannDriveStamped)
        asker = Asker(peer)
        assert not asker.ask(math.nan, 0.0)
        assert not asker.ask(0.0, math.inf)
        assert not asker.ask(1.0, 0.0, math.nan)
        node.wait_for_words("are not all numbers")
        assert not asker.ask(1e6, 0.0)
        node.wait_for_words("farther away than 20 m (max_distance)")
        assert not asker.ask(1.0, 0.0, -1.0)
        assert not asker.ask(1.0, 0.0, 0.001)
        node.wait_for_words("tolerance 0.001 m, must be 0 or from 0.02 to 2 m")
        assert not drive


def test_it_ends_in_the_middle_of_a_drive_with_a_stop_and_a_result(peer: Peer, ros_domain: int) -> None:
    with NodeProcess(MODULE, ros_domain, params=SIMULATED) as node:
        drive = peer.hear("/drive", AckermannDriveStamped)
        asker = Asker(peer)
        assert asker.ask(9.0, 0.0)
        wait_for_motion(drive)
        result = asker.result()
        assert not asker.ask(math.nan, 0.0), "an answer, by which time the node has the question"
        node.send(signal.SIGINT)
        assert node.wait() == 0
        assert "Traceback" not in node.output
        wait_for_stop(drive)
        wait_until(result.done, "a last word")
        assert "ending" in result.result().result.message
