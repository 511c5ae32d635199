"""std_msgs/ByteMultiArray to bytes and back.

In rclpy its `data` is a list of bytes objects of length 1: `bytes(data)` is a TypeError.
"""

from __future__ import annotations

from std_msgs.msg import ByteMultiArray


def sound_message(sound: bytes) -> ByteMultiArray:
    """Return samples (signed, 16 bit, little-endian, mono) as ROS wants them: each byte a bytes of its own."""
    return ByteMultiArray(data=[sound[at : at + 1] for at in range(len(sound))])


def sound_of(message: ByteMultiArray) -> bytes:
    """Return the samples of a message, as `sound_message` takes them."""
    return b"".join(message.data)
