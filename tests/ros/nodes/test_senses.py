"""Camera, vision stub, microphone and loudspeaker, the camera's place, and hello."""

from __future__ import annotations

import math
from array import array
from operator import sub
from statistics import median

import numpy as np
import pytest
from geometry_msgs.msg import PoseStamped
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import SetParameters
from sensor_msgs.msg import Image, JointState
from std_msgs.msg import ByteMultiArray, Float32
from tf2_msgs.msg import TFMessage

from tests.ros.node_process import NodeProcess
from tests.ros.peer import LATCHED, Peer
from tests.waiting import wait_until

pytestmark = pytest.mark.nightly

CAMERA = "/camera/color/image_raw"


@pytest.mark.parametrize("encoding", ["bgr8", "rgb8"])
def test_the_camera_films_a_blue_sky(peer: Peer, ros_domain: int, encoding: str) -> None:
    with NodeProcess("nodes.mock_camera", ros_domain, params={"encoding": encoding}):
        pictures = peer.hear(CAMERA, Image)
        wait_until(lambda: len(pictures) >= 3, "three pictures")
    first, last = pictures[0], pictures[-1]
    assert (first.width, first.height, first.step) == (640, 480, 1920)
    assert first.encoding == encoding
    assert first.header.frame_id == "camera_color_optical_frame"
    stamps = [
        picture.header.stamp.sec * 10**9 + picture.header.stamp.nanosec for picture in pictures
    ]
    assert stamps == sorted(set(stamps))
    picture = np.frombuffer(first.data, np.uint8).reshape(480, 640, 3)
    blue, red = picture[2, 320, 0], picture[2, 320, 2]
    assert (blue > red) == (encoding == "bgr8")
    assert first.data != last.data


def test_the_camera_keeps_its_ten_pictures_a_second(peer: Peer, ros_domain: int) -> None:
    with NodeProcess("nodes.mock_camera", ros_domain):
        pictures = peer.hear(CAMERA, Image)
        wait_until(lambda: len(pictures) >= 31, "31 pictures")
    stamps = [one.header.stamp.sec + one.header.stamp.nanosec / 1e9 for one in pictures[:31]]
    # The usual gap: one may be long, where the machine was held up.
    assert median(map(sub, stamps[1:], stamps)) == pytest.approx(0.1, rel=0.1)


def picture(encoding: str = "bgr8", **changes: int) -> Image:
    sizes = {"width": 4, "height": 2, "step": 12, **changes}
    return Image(encoding=encoding, data=array("B", bytes(24)), **sizes)


def test_the_vision_stub_takes_both_orders_and_refuses_what_is_no_picture(
    peer: Peer, ros_domain: int
) -> None:
    with NodeProcess("nodes.vlm_agent_stub", ros_domain, params={"period": 0.2}) as node:
        node.wait_for_words("[WARN]", "No picture yet")
        for encoding in ("bgr8", "rgb8"):
            with peer.saying(CAMERA, picture(encoding)):
                node.wait_for_words("Picture 4x2 -> JPEG")
        assert "refused" not in node.output
        with peer.saying(CAMERA, picture("16UC1")):
            node.wait_for_words("refused: encoding 16UC1, but only bgr8 and rgb8")
        with peer.saying(CAMERA, picture(width=4000)):
            node.wait_for_words("refused: 4000x2 pixels, 12 bytes a row")
        node.wait_for_words("No new picture")


def test_somebody_speaks_and_the_loudspeaker_is_heard(peer: Peer, ros_domain: int) -> None:
    params: dict[str, object] = {"first_after": 0.5, "period": 0.5}
    with NodeProcess("nodes.mock_audio", ros_domain, params=params, lang="ru") as node:
        heard = peer.hear("/audio/mic_raw", ByteMultiArray)
        levels = peer.hear("/audio/level", Float32)
        wait_until(lambda: len(heard) >= 2, "two phrases")
        wait_until(lambda: any(level.data > -35 for level in levels), "a loud voice")
        assert all(isinstance(byte, bytes) and len(byte) == 1 for byte in heard[0].data)
        words = b"".join(heard[0].data).decode()
        assert words == "VOICE_COMMAND: осмотрись и расскажи, что там"
        peer.say("/audio/speaker_raw", ByteMultiArray(data=[b"h", b"i", b"\xff", b"\x1b", b"\n"]))
        node.wait_for_words("Динамик воспроизводит: «hi�␛␊»")


def test_nobody_speaks_until_there_is_a_period(peer: Peer, ros_domain: int) -> None:
    params: dict[str, object] = {"first_after": 0.1, "period": 0.0}
    with NodeProcess("nodes.mock_audio", ros_domain, params=params):
        heard = peer.hear("/audio/mic_raw", ByteMultiArray)
        levels = peer.hear("/audio/level", Float32)
        wait_until(lambda: len(levels) >= 5, "five levels")
        assert heard == []
        value = ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=0.2)
        request = SetParameters.Request(parameters=[Parameter(name="period", value=value)])
        assert (
            peer.ask("/audio_system/set_parameters", SetParameters, request).results[0].successful
        )
        wait_until(lambda: len(heard) >= 2, "two phrases")


def test_the_place_of_the_camera_is_latched(peer: Peer, ros_domain: int) -> None:
    params: dict[str, object] = {"yaw": 1.5707963}
    with NodeProcess("nodes.camera_tf", ros_domain, params=params) as node:
        node.wait_for_words("camera_link relative to base_link: x 0.15")
        heard = peer.hear("/tf_static", TFMessage, LATCHED)
        wait_until(lambda: heard, "the transform, late")
        (place,) = heard[0].transforms
        assert (place.header.frame_id, place.child_frame_id) == ("base_link", "camera_link")
        moved = place.transform.translation
        assert (moved.x, moved.y, moved.z) == (0.15, 0.0, 0.25)
        assert place.transform.rotation.z == pytest.approx(0.5**0.5)
        value = ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=0.2)
        request = SetParameters.Request(parameters=[Parameter(name="x", value=value)])
        assert peer.ask("/camera_tf/set_parameters", SetParameters, request).results[0].successful
        wait_until(lambda: heard[-1].transforms[0].transform.translation.x == 0.2, "the new place")


def test_hello_counts(ros_domain: int) -> None:
    with NodeProcess("nodes.hello", ros_domain, params={"period": 0.05}) as node:
        node.wait_for_words("Hello!", "0.1 s passed", "0.3 s passed")


def away(message: Image, data: bytes) -> float:
    """How different a picture is from another one, 0 to 255."""
    pixels = (np.frombuffer(one, np.uint8).astype(int) for one in (message.data, data))
    return float(np.abs(next(pixels) - next(pixels)).mean())


def test_the_camera_of_the_simulated_robot_sees_where_it_looks(peer: Peer, ros_domain: int) -> None:
    params: dict[str, object] = {"scene": "room", "rate": 30, "width": 64, "height": 48}
    with NodeProcess("nodes.mock_camera", ros_domain, params=params) as node:
        pictures = peer.hear(CAMERA, Image)
        node.wait_for_words("Nobody publishes /mock/pose")
        wait_until(lambda: pictures, "a first picture")
        at_the_start = bytes(pictures[-1].data)
        turned = PoseStamped()
        turned.pose.orientation.z = turned.pose.orientation.w = 0.5**0.5
        peer.say("/mock/pose", turned)
        wait_until(lambda: bytes(pictures[-1].data) != at_the_start, "another picture")
        # The head back to where the robot looked at the start; the camera sits a little elsewhere.
        looks = JointState(name=["pan_joint", "tilt_joint"], position=[-math.pi / 2, 0.3])
        peer.say("/head_state", looks)
        wait_until(lambda: away(pictures[-1], at_the_start) > 25, "a raised look")
        looks.position[1] = 0.0
        peer.say("/head_state", looks)
        wait_until(lambda: away(pictures[-1], at_the_start) < 25, "the look of the start")
        peer.say("/head_state", JointState(name=["pan_joint", "tilt_joint"]))
        wait_until(lambda: away(pictures[-1], at_the_start) > 25, "straight ahead")
