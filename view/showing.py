"""The robot in Rerun: an observer of its own feeds a viewer, until one of them ends."""

from __future__ import annotations

import os
from contextlib import ExitStack
from typing import TYPE_CHECKING, Any

from graph.data import Interest
from graph.observer.observer import Observer
from text.i18n import _
from view.page import ViewPage
from view.place import DATA_PORT, PAGE_PORT, Place, ViewError, free_port, is_free, rerun_program
from view.scene import LOG, PICTURE_TYPES, PICTURES, PLOTS, ViewScene
from view.shapes import WORLD, topic_path
from view.viewer import Viewer

if TYPE_CHECKING:
    import threading
    from collections.abc import Iterable
    from pathlib import Path

    from typing_extensions import Self

    from graph.data import GraphUpdate
    from view.shapes import Drawn

ROLE = "view"
LOOK_S = 0.1
TRIES = 3


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

    def arrange(self, blueprint: Any) -> None:  # noqa: ANN401
        self._recording.send_blueprint(blueprint)

    def close(self) -> None:
        """Send what waits, for a moment at most, and hang up."""
        self._recording.disconnect()


EYE_M, BEFORE_M = (-0.75, -0.65, 0.55), (0.1, 0.0, 0.1)
"""Where one looks from and to at first, metres: behind a robot at the start of its way."""
FLAT = (PICTURES, PLOTS, LOG)
"""What has no place in 3D."""


def arranged(pictures: Iterable[str]) -> Any:  # noqa: ANN401
    """Return the arrangement for these topics with pictures, named in the user's language."""
    import rerun.blueprint as rrb

    space = rrb.Spatial3DView(
        origin="/",
        contents=["+ /**", *(f"- /{root}/**" for root in FLAT)],
        name=_("Space"),
        spatial_information=rrb.SpatialInformation(WORLD),
        eye_controls=rrb.EyeControls3D(position=EYE_M, look_target=BEFORE_M),
    )
    cameras = [rrb.Spatial2DView(origin=_entity(topic), name=topic) for topic in sorted(pictures)] or [
        rrb.Spatial2DView(origin=f"/{PICTURES}", name=_("Camera"))
    ]
    plots = rrb.TimeSeriesView(origin=f"/{PLOTS}", name=_("Numbers"))
    log = rrb.TextLogView(origin=f"/{LOG}", name=_("Logs"))
    return rrb.Blueprint(
        rrb.Horizontal(
            space, rrb.Vertical(rrb.Tabs(*cameras), plots, log, row_shares=[3, 2, 2]), column_shares=[3, 2]
        ),
        rrb.BlueprintPanel(state="collapsed"),
        rrb.SelectionPanel(state="collapsed"),
        rrb.TimePanel(state="collapsed", timeline=TIMELINE),
    )


def _entity(topic: str) -> str:
    return "/" + "/".join(topic_path(PICTURES, topic))


class Showing:
    """A viewer and what feeds it; open it, wait, close it."""

    def __init__(
        self,
        domain: int,
        discovery: str | tuple[str, ...],
        *,
        window: bool = False,
        port: int | None = None,
        compact: bool = False,
    ) -> None:
        """Open a window of its own, or a page at `port`, near the usual one if there is none.

        With `compact`, pictures are compressed, for a browser behind a slow line.

        Raises ViewError if nothing can be opened.
        """
        program = rerun_program()
        self.error = ""
        """Why nothing is shown any more."""
        self._scene = ViewScene(compact=compact)
        self._pictures: frozenset[str] = frozenset()
        self._open = ExitStack()
        page_port = 0 if window else free_port(PAGE_PORT, port)
        with ExitStack() as opening:
            self._viewer = opening.enter_context(_started(program, page_port))
            if not window:
                # Another view may have taken it while Rerun came up.
                page_port = free_port(PAGE_PORT, port)
            self.place = Place(self._viewer.data_port, page_port)
            """Where the page is; a window's page port is 0."""
            if self._viewer.page_port is not None:
                opening.enter_context(ViewPage(self.place, self._viewer.page_port))
            self._stream = Stream(self.place.source)
            opening.callback(self._stream.close)
            self._stream.arrange(arranged(self._pictures))
            self._observer = Observer(domain, discovery, role=ROLE)
            opening.callback(self._observer.stop)
            self._observer.start(self._take)
            self._open = opening.pop_all()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._open.close()

    @property
    def url(self) -> str:
        """The page that shows it, empty for a window."""
        return self.place.url if self.place.page_port else ""

    @property
    def ports(self) -> tuple[int, ...]:
        """The ports that a browser needs: the page's and the data's; none for a window."""
        return (self.place.page_port, self.place.data_port) if self.place.page_port else ()

    def wait(self, stop: threading.Event) -> None:
        """Wait until it is stopped or its window is closed. Raises ViewError if it broke."""
        while not stop.wait(LOOK_S):
            if self.error:
                raise ViewError(self.error)
            if self._viewer.ended:
                if fault := self._viewer.fault:
                    raise ViewError(fault)
                return

    def _take(self, update: GraphUpdate) -> None:
        """Draw what has come; called by the observer's thread."""
        if update.error:
            self.error = update.error
            return
        wanted = self._scene.wanted(update.topics)
        small = wanted & self._scene.seen_small(update.topics)
        followed = wanted & self._scene.every_one_of(update.topics) - small
        watched = frozenset(wanted - followed - small)
        self._observer.want(Interest(watched, frozenset(followed), pictures=frozenset(small)))
        pictures = frozenset(
            row.name for row in update.topics if row.name in wanted and not PICTURE_TYPES.isdisjoint(row.type_names)
        )
        if pictures - self._pictures:
            self._pictures |= pictures
            self._stream.arrange(arranged(self._pictures))
        found = [sample for samples in update.samples.values() for sample in samples]
        for time_s, drawn in self._scene.draw(found):
            self._stream.put(time_s, drawn)


def _started(program: Path, page_port: int) -> Viewer:
    """Return a viewer that has come up, at ports that nobody else has taken meanwhile."""
    for left in range(TRIES, 0, -1):
        data_port = free_port(DATA_PORT)
        inner_port = free_port(page_port + 1) if page_port else None
        try:
            return Viewer(program, data_port, inner_port)
        except ViewError:
            taken = not is_free(data_port) or (inner_port is not None and not is_free(inner_port))
            if left == 1 or not taken:
                raise
    raise AssertionError
