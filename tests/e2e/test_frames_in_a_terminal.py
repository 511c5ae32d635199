"""The frames of lesson 5 on the smallest terminal: where the camera is, and what is wrong."""

from __future__ import annotations

import pytest
from geometry_msgs.msg import TransformStamped
from tf2_msgs.msg import TFMessage

from tests.e2e.conftest import Deck
from tests.ros.peer import Peer
from tests.waiting import wait_until

pytestmark = pytest.mark.nightly


def test_the_camera_of_lesson_5_and_a_stranger_s_frame(deck: Deck, ros_domain: int) -> None:
    terminal = deck.open("05-tf2", "--lang", "en", columns=80, rows=24)
    terminal.wait_for("1/1")
    terminal.press("8")
    terminal.wait_for("camera_tf")
    terminal.wait_for("nothing is wrong with the frames")
    terminal.press("down")
    terminal.wait_for("camera_link in base_link")
    terminal.wait_for("0.150    0.000    0.250")
    with Peer(ros_domain, "stranger") as stranger:
        publisher = stranger.publisher("/tf", TFMessage)
        made = TransformStamped(child_frame_id="lens")
        made.header.frame_id = "camera_lnk"

        def found() -> bool:
            made.header.stamp = stranger.node.get_clock().now().to_msg()
            publisher.publish(TFMessage(transforms=[made]))
            return "is camera_lnk a slip for camera_link?" in terminal.text()

        wait_until(found, "the slip in the name of the parent")
        # Nobody publishes it any more.
        terminal.wait_for("lens: silent for")
    terminal.press("q")
    assert terminal.wait_exit() == 0
