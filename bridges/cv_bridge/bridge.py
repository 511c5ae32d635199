"""Between the messages of images and the arrays that OpenCV works on."""

from __future__ import annotations

import sys
from array import array
from typing import Any

import cv2
import numpy as np
import numpy.typing as npt
from sensor_msgs.msg import CompressedImage, Image

from cv_bridge.colours import CvBridgeError, convert, known
from cv_bridge.encodings import DEPTH_NAMES, DEPTHS

Picture = npt.NDArray[Any]


class CvBridge:
    """Converts images, without any state of its own."""

    def __init__(self) -> None:
        self.cvtype_to_name: dict[int, str] = {
            getattr(cv2, f"CV_{depth}C{channels}"): f"{depth}C{channels}"
            for depth in DEPTHS
            for channels in (1, 2, 3, 4)
        }
        self.numpy_type_to_cvtype: dict[str, str] = DEPTH_NAMES | DEPTHS

    def dtype_with_channels_to_cvtype2(self, dtype: Any, n_channels: int) -> str:
        """Return OpenCV's name for a type of numpy and a number of channels: 8UC3."""
        name = np.dtype(dtype).name
        if name not in DEPTH_NAMES:
            raise CvBridgeError(f"OpenCV has no images of {name}")
        return f"{DEPTH_NAMES[name]}C{n_channels}"

    def cvtype2_to_dtype_with_channels(self, cvtype: int) -> tuple[str, int]:
        """Return numpy's name and the number of channels of a type of OpenCV."""
        depth, _, channels = self.cvtype_to_name[cvtype].partition("C")
        return DEPTHS[depth], int(channels)

    def encoding_to_cvtype2(self, encoding: str) -> int:
        """Return the type of OpenCV, such as cv2.CV_8UC3, of an encoding."""
        found = known(encoding)
        depth = getattr(cv2, f"CV_{found.depth}")
        return int(cv2.CV_MAKETYPE(depth, found.channels))

    def encoding_to_dtype_with_channels(self, encoding: str) -> tuple[str, int]:
        """Return numpy's name and the number of channels of an encoding."""
        found = known(encoding)
        return found.dtype, found.channels

    def imgmsg_to_cv2(self, img_msg: Any, desired_encoding: str = "passthrough") -> Picture:
        """Return the picture of an Image, in the encoding it has or in the desired one."""
        found = known(img_msg.encoding)
        dtype = np.dtype(found.dtype).newbyteorder(">" if img_msg.is_bigendian else "<")
        height, width, step = img_msg.height, img_msg.width, img_msg.step
        row = width * found.channels * dtype.itemsize
        data = np.frombuffer(_bytes_of(img_msg.data), np.uint8)
        if step < row or data.size < height * step:
            raise CvBridgeError(
                f"an image of {width}x{height} in {img_msg.encoding} needs rows of {row} bytes; "
                f"this one has step {step} and {data.size} bytes in all"
            )
        # A row may be longer than its pixels.
        rows = data[: height * step].reshape(height, step)[:, :row]
        shape = (height, width) if found.channels == 1 else (height, width, found.channels)
        values = np.ascontiguousarray(rows).view(dtype).reshape(shape)
        # OpenCV knows only this machine's order of bytes; what it returns may be drawn into.
        picture = values.astype(dtype.newbyteorder("="))
        if desired_encoding == "passthrough":
            return picture
        return convert(picture, img_msg.encoding, desired_encoding)

    def cv2_to_imgmsg(self, cvim: Picture, encoding: str = "passthrough", header: Any = None) -> Image:
        """Return an Image of a picture, whose type has to fit the encoding."""
        if not isinstance(cvim, np.ndarray | np.generic):
            raise TypeError("Your input type is not a numpy array")
        if cvim.ndim not in {2, 3}:
            raise CvBridgeError(f"an image has rows and columns, and not {cvim.ndim} dimensions")
        kind = self.dtype_with_channels_to_cvtype2(cvim.dtype, 1 if cvim.ndim == 2 else cvim.shape[2])
        if encoding != "passthrough" and known(encoding).generic != kind:
            raise CvBridgeError(f"encoding specified as {encoding}, but image has incompatible type {kind}")
        message = Image()
        if header is not None:
            message.header = header
        message.height, message.width = cvim.shape[:2]
        message.encoding = kind if encoding == "passthrough" else encoding
        message.is_bigendian = int(
            cvim.dtype.byteorder == ">" or (cvim.dtype.byteorder == "=" and sys.byteorder == "big")
        )
        data = cvim.tobytes()
        # rclpy looks at each number of a list, and at none of an array.
        message.data = array("B", data)
        message.step = len(data) // message.height if message.height else 0
        return message

    def compressed_imgmsg_to_cv2(self, cmprs_img_msg: Any, desired_encoding: str = "passthrough") -> Picture:
        """Return the picture of a CompressedImage; it has the order bgr unless asked otherwise."""
        data = np.frombuffer(_bytes_of(cmprs_img_msg.data), np.uint8)
        picture = cv2.imdecode(data, cv2.IMREAD_UNCHANGED) if data.size else None
        if picture is None:
            raise CvBridgeError(f"{data.size} bytes of format '{cmprs_img_msg.format}' are no compressed image")
        if desired_encoding == "passthrough":
            return np.asarray(picture)
        channels = 1 if picture.ndim == 2 else picture.shape[2]
        colours = {1: "mono", 3: "bgr", 4: "bgra"}[channels]
        return convert(picture, f"{colours}{8 * picture.itemsize}", desired_encoding)

    def cv2_to_compressed_imgmsg(self, cvim: Picture, dst_format: str = "jpg") -> CompressedImage:
        """Return a CompressedImage of a picture: jpg, png, or what else OpenCV writes."""
        if not isinstance(cvim, np.ndarray | np.generic):
            raise TypeError("Your input type is not a numpy array")
        try:
            worked, data = cv2.imencode(f".{dst_format}", np.asarray(cvim))
        except cv2.error as error:
            raise CvBridgeError(f"OpenCV cannot write {dst_format}: {error}") from error
        if not worked:
            raise CvBridgeError(f"OpenCV cannot write {dst_format}")
        message = CompressedImage()
        message.format = dst_format
        message.data = array("B", data.tobytes())
        return message


def _bytes_of(data: Any) -> Any:
    """Return what can be read as bytes: a field of bytes may hold a list."""
    return bytes(data) if isinstance(data, list | tuple) else data
