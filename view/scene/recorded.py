"""The stream of what is drawn to the viewer's server."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from view.scene.drawn import Drawn

APPLICATION = "deck"
TIMELINE = "time"


class Stream:
    """Sends to the server of a viewer on this machine; never waits for it."""

    def __init__(self, source: str) -> None:
        """Connect to `source`, in Rerun's own notation of an address."""
        # That a viewer has been closed is no error of the stream's, to be printed on a terminal.
        os.environ.setdefault("RUST_LOG", "off")
        import rerun

        self._recording = rerun.RecordingStream(APPLICATION, send_properties=False)
        self._recording.connect_grpc(source)

    def put(self, time_s: float, drawn: Drawn) -> None:
        """Send one thing that is drawn at a time, unix time in seconds."""
        import rerun

        shapes = list(drawn.shapes)
        if drawn.recursive:
            shapes.append(rerun.Clear(recursive=True))
        if drawn.frame:
            shapes.append(rerun.CoordinateFrame(drawn.frame))
        self._recording.set_time(TIMELINE, timestamp=time_s)
        self._recording.log(list(drawn.path), *shapes, static=drawn.static)

    def arrange(self, blueprint: Any) -> None:  # noqa: ANN401 - rerun comes without types
        self._recording.send_blueprint(blueprint)

    def close(self) -> None:
        """Send what waits, for a moment at most, and hang up."""
        self._recording.disconnect()
