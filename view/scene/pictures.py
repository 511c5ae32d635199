"""Pictures of cameras, colours and depth."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from graph.pictures.compressed import to_jpeg
from graph.pictures.picture import COMPRESSED, IMAGE, METRES, read_picture
from graph.pictures.pixels import pixels_of
from view.scene.drawn import Drawn, topic_path

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from view.scene.drawn import Message

PICTURES = "pictures"
"""The root of all pictures in the tree of entities."""
AS_IT_IS = {b"\xff\xd8\xff": "image/jpeg", b"\x89PNG": "image/png"}
"""The first bytes of what the viewer decodes itself."""


def image(topic: str, message: Message, *, compact: bool) -> list[Drawn]:
    """Return a `sensor_msgs/Image`, as JPEG if it is to be `compact`. Raises ImageError."""
    import rerun

    if message["encoding"] in METRES:
        metre = 1 / METRES[message["encoding"]]
        shape = rerun.DepthImage(_numbers(message), meter=metre)
    else:
        shape = _picture(IMAGE, message, compact=compact)
    return [Drawn(topic_path(PICTURES, topic), (shape,))]


def compressed(topic: str, message: Message, *, compact: bool) -> list[Drawn]:
    """Return a `sensor_msgs/CompressedImage`, still compressed if that will do.

    Raises ImageError.
    """
    import rerun

    data = bytes(message["data"])
    kind = next((kind for first, kind in AS_IT_IS.items() if data.startswith(first)), "")
    if kind and compact:
        shape = rerun.EncodedImage(contents=data, media_type=kind)
    else:
        shape = _picture(COMPRESSED, message, compact=compact)
    return [Drawn(topic_path(PICTURES, topic), (shape,))]


def _picture(type_name: str, message: Message, *, compact: bool) -> Any:  # noqa: ANN401
    import rerun

    rgb = read_picture(type_name, message, lambda width, height: (width, height)).rgb
    if compact:
        return rerun.EncodedImage(contents=to_jpeg(rgb), media_type="image/jpeg")
    # A viewer on this machine shows them at once, and would take longer to decode them.
    return rerun.Image(rgb)


def _numbers(message: Message) -> NDArray[np.generic]:
    """Return the pixels of a depth image, shape (height, width)."""
    numbers = pixels_of(message)[:, :, 0]
    # Rerun reads the machine's own order of bytes.
    return numbers.astype(numbers.dtype.newbyteorder("="))
