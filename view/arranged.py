"""How the viewer is arranged: the robot in 3D, its cameras, numbers and log."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from text.i18n import _
from view.scene.drawn import WORLD, topic_path
from view.scene.log import LOG
from view.scene.pictures import PICTURES
from view.scene.plots import PLOTS
from view.scene.recorded import TIMELINE

if TYPE_CHECKING:
    from collections.abc import Iterable

EYE_M, BEFORE_M = (-0.75, -0.65, 0.55), (0.1, 0.0, 0.1)
"""Where one looks from and to at first, metres: behind a robot at the start of its way."""
FLAT = (PICTURES, PLOTS, LOG)
"""What has no place in 3D."""


def arranged(pictures: Iterable[str]) -> Any:  # noqa: ANN401 - rerun comes without types
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
