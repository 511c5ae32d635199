"""Pictures of every encoding become messages and come back, and what makes no sense is refused."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from cv_bridge import CvBridge, CvBridgeError
from sensor_msgs.msg import CompressedImage, Image

ENCODINGS = {
    "mono8": ("uint8", 1), "mono16": ("uint16", 1), "bgr8": ("uint8", 3), "rgb8": ("uint8", 3),
    "bgra8": ("uint8", 4), "rgba8": ("uint8", 4), "bgr16": ("uint16", 3), "rgba16": ("uint16", 4),
    "8UC1": ("uint8", 1), "8UC2": ("uint8", 2), "8UC3": ("uint8", 3), "16UC1": ("uint16", 1),
    "16SC4": ("int16", 4), "32SC1": ("int32", 1), "32FC1": ("float32", 1), "64FC3": ("float64", 3),
    "bayer_rggb8": ("uint8", 1), "bayer_gbrg16": ("uint16", 1), "yuv422": ("uint8", 2),
}  # fmt: skip
RED = (0, 0, 255)


@pytest.fixture
def bridge() -> CvBridge:
    return CvBridge()


def picture(dtype: str, channels: int) -> Any:
    """Return a picture in which no two pixels are alike."""
    shape = (4, 6) if channels == 1 else (4, 6, channels)
    return np.arange(int(np.prod(shape))).astype(dtype).reshape(shape)


@pytest.mark.parametrize("encoding", ENCODINGS)
def test_a_picture_comes_back_as_it_was(bridge: CvBridge, encoding: str) -> None:
    drawn = picture(*ENCODINGS[encoding])
    message = bridge.cv2_to_imgmsg(drawn, encoding)
    assert (message.height, message.width, message.encoding) == (4, 6, encoding)
    assert message.step * 4 == len(message.data) == drawn.nbytes
    assert bridge.encoding_to_dtype_with_channels(encoding) == ENCODINGS[encoding]
    back = bridge.imgmsg_to_cv2(message)
    assert back.dtype == drawn.dtype
    assert np.array_equal(back, drawn)
    # Drawn into, as cv2.putText does.
    back[0, 0] = 1


@pytest.mark.parametrize(
    ("encoding", "expected"),
    [
        ("rgb8", (255, 0, 0)),
        ("bgra8", (0, 0, 255, 255)),
        ("rgba8", (255, 0, 0, 255)),
        ("mono8", 76),
        ("rgb16", (65535, 0, 0)),
        ("8UC3", RED),
    ],
)
def test_colours_are_converted(bridge: CvBridge, encoding: str, expected: Any) -> None:
    message = bridge.cv2_to_imgmsg(np.full((4, 6, 3), RED, np.uint8), "bgr8")
    found = bridge.imgmsg_to_cv2(message, desired_encoding=encoding)
    assert np.all(found == np.array(expected))


def test_the_order_of_bytes_is_the_messages(bridge: CvBridge) -> None:
    message = Image(height=1, width=2, step=4, encoding="mono16", data=bytes([1, 0, 0, 2]))
    message.is_bigendian = 1
    assert bridge.imgmsg_to_cv2(message).tolist() == [[256, 2]]
    message.is_bigendian = 0
    assert bridge.imgmsg_to_cv2(message).tolist() == [[1, 512]]
    sent = bridge.cv2_to_imgmsg(np.array([[258]], ">u2"), "mono16")
    assert (sent.is_bigendian, bytes(sent.data)) == (1, b"\x01\x02")


@pytest.mark.parametrize(
    ("source", "target", "words"),
    [
        ("8UC3", "bgr8", "not a color format"),
        ("16UC1", "mono8", "not a color format"),
        ("bgr8", "mono9", r"Unrecognized image encoding \[mono9\]"),
        ("bgr8", "32FC1", "same number of channels"),
        ("bgr8", "bayer_rggb8", "Unsupported conversion"),
    ],
)
def test_what_makes_no_sense_is_refused(bridge: CvBridge, source: str, target: str, words: str) -> None:
    message = bridge.cv2_to_imgmsg(picture(*ENCODINGS[source]), source)
    with pytest.raises(CvBridgeError, match=words):
        bridge.imgmsg_to_cv2(message, target)


def test_a_picture_of_another_type_or_too_short_is_refused(bridge: CvBridge) -> None:
    with pytest.raises(CvBridgeError, match="encoding specified as bgr8, but image has incompat"):
        bridge.cv2_to_imgmsg(picture("uint8", 1), "bgr8")
    with pytest.raises(TypeError, match="not a numpy array"):
        bridge.cv2_to_imgmsg(bytes(3))  # type: ignore[arg-type]
    with pytest.raises(CvBridgeError, match="needs rows of 1920 bytes"):
        bridge.imgmsg_to_cv2(Image(height=480, width=640, step=1920, encoding="bgr8"))


@pytest.mark.parametrize("kind", ["png", "jpg"])
def test_a_compressed_picture_comes_back(bridge: CvBridge, kind: str) -> None:
    message = bridge.cv2_to_compressed_imgmsg(np.full((40, 60, 3), RED, np.uint8), kind)
    assert message.format == kind
    found = bridge.compressed_imgmsg_to_cv2(message, "rgb8")
    assert found.shape == (40, 60, 3)
    assert np.all(np.abs(found.astype(int) - (255, 0, 0)) < 4)
    assert bridge.compressed_imgmsg_to_cv2(message)[0, 0, 2] > 250


def test_what_is_no_compressed_picture_is_refused(bridge: CvBridge) -> None:
    for data in (b"", b"noise"):
        with pytest.raises(CvBridgeError, match="no compressed image"):
            bridge.compressed_imgmsg_to_cv2(CompressedImage(format="jpg", data=data))
    with pytest.raises(CvBridgeError, match="cannot write film"):
        bridge.cv2_to_compressed_imgmsg(picture("uint8", 3), "film")
