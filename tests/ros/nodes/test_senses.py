"""Camera, vision stub, microphone and loudspeaker, the camera's place, and hello."""

from __future__ import annotations

from array import array

import numpy as np
import pytest
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import SetParameters
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import Image
from std_msgs.msg import ByteMultiArray, Float32
from tf2_msgs.msg import TFMessage

from tests.ros.node_thread import NodeThread
from tests.ros.peer import LATCHED, Peer
from tests.waiting import wait_until

FRONT = "/sensor/sonar_front"
CAMERA = "/camera/color/image_raw"


@pytest.mark.parametrize("encoding", ["bgr8", "rgb8"])
def test_the_camera_films_a_blue_sky(peer: Peer, ros_domain: int, encoding: str) -> None:
    with NodeThread("nodes.mock_camera", ros_domain, params={"encoding": encoding}):
        pictures = peer.hear(CAMERA, Image)
        wait_until(lambda: len(pictures) >= 3, "three pictures")
    first, last = pictures[0], pictures[-1]
    assert (first.width, first.height, first.step) == (640, 480, 1920)
    assert first.encoding == encoding
    assert first.header.frame_id == "camera_color_optical_frame"
    stamps = [picture.header.stamp.sec * 10**9 + picture.header.stamp.nanosec for picture in pictures]
    assert stamps == sorted(set(stamps))
    picture = np.frombuffer(first.data, np.uint8).reshape(480, 640, 3)
    blue, red = picture[2, 320, 0], picture[2, 320, 2]
    assert (blue > red) == (encoding == "bgr8")
    assert first.data != last.data


def picture(encoding: str = "bgr8", **changes: int) -> Image:
    sizes = {"width": 4, "height": 2, "step": 12, **changes}
    return Image(encoding=encoding, data=array("B", bytes(24)), **sizes)


def test_the_vision_stub_takes_both_orders_and_refuses_what_is_no_picture(peer: Peer, ros_domain: int) -> None:
    with NodeThread("nodes.vlm_agent_stub", ros_domain, params={"period": 0.2}) as node:
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
    with NodeThread("nodes.mock_audio", ros_domain, params=params, lang="ru") as node:
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
    with NodeThread("nodes.mock_audio", ros_domain, params=params):
        heard = peer.hear("/audio/mic_raw", ByteMultiArray)
        levels = peer.hear("/audio/level", Float32)
        wait_until(lambda: len(levels) >= 5, "five levels")
        assert heard == []
        value = ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=0.2)
        request = SetParameters.Request(parameters=[Parameter(name="period", value=value)])
        assert peer.ask("/audio_system/set_parameters", SetParameters, request).results[0].successful
        wait_until(lambda: len(heard) >= 2, "two phrases")


def test_the_place_of_the_camera_is_latched(peer: Peer, ros_domain: int) -> None:
    params: dict[str, object] = {"yaw": 1.5707963}
    with NodeThread("nodes.camera_tf", ros_domain, params=params) as node:
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


def test_a_camera_that_publishes_by_best_effort_is_seen(peer: Peer, ros_domain: int) -> None:
    peer.publisher(CAMERA, Image, qos_profile_sensor_data)
    picture = Image(encoding="bgr8", width=4, height=2, step=12, data=array("B", bytes(24)))
    with NodeThread("nodes.vlm_agent_stub", ros_domain, params={"period": 0.2}) as node, peer.saying(CAMERA, picture):
        node.wait_for_words("Picture 4x2 -> JPEG")
