"""The arithmetic of transforms, without topics: what tf2_ros stands on.

It has the names of the package tf2_py, and code of Deck's own in pure Python, for a ROS that comes
without. Where a ROS brings that package, Python finds it first.
"""

from tf2_py.core import BufferCore
from tf2_py.exceptions import (
    ConnectivityException,
    ExtrapolationException,
    InvalidArgumentException,
    LookupException,
    TimeoutException,
    TransformException,
)

__all__ = [
    "BufferCore",
    "ConnectivityException",
    "ExtrapolationException",
    "InvalidArgumentException",
    "LookupException",
    "TimeoutException",
    "TransformException",
]
