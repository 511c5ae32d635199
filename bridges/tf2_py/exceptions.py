"""Why there is no transform.

- TransformException
    - LookupException: a frame is not known
    - ConnectivityException: no way leads from one frame to the other
    - ExtrapolationException: not at that time
    - InvalidArgumentException: a frame has no proper name
    - TimeoutException
"""


class TransformException(Exception):  # noqa: N818 - tf2's own names
    """There is no transform."""


class LookupException(TransformException):
    """A frame is not known."""


class ConnectivityException(TransformException):
    """Both frames are known, and not connected."""


class ExtrapolationException(TransformException):
    """The frames are connected, but not at the time that was asked for."""


class InvalidArgumentException(TransformException):
    """The question itself is wrong."""


class TimeoutException(TransformException):
    """It took too long."""
