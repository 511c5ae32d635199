"""Where the head looks, and what the LLM's commands told it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robot.joints import HEAD_PAN, HEAD_TILT
from robot.topics import HEAD_STATE, LLM_RESULT
from text.i18n import N_, _
from text.nested import read_json
from tui.panels.head.reading import HeadReading, head_in
from tui.panels.head.widget import HeadView
from tui.panels.joints import Joints
from tui.panels.panel import Panel, trouble_of

if TYPE_CHECKING:
    from textual.app import ComposeResult

    from graph.data import GraphUpdate


class HeadPanel(Panel):
    """Pan and tilt, from above and from the side."""

    title = N_("Head")
    least = 3
    weight = 4

    def __init__(self) -> None:
        super().__init__()
        self._joints = Joints(HEAD_STATE, (HEAD_PAN, HEAD_TILT))

    def compose(self) -> ComposeResult:
        yield HeadView()

    def watched(self) -> set[str]:
        return {HEAD_STATE}

    def followed(self) -> set[str]:
        """The topics with the outcome of LLM commands."""
        return {LLM_RESULT}

    def show(self, update: GraphUpdate) -> None:
        """Show the newest pose and the newest command."""
        drawing = self.query_one(HeadView)
        for sample in update.samples.get(HEAD_STATE, ()):
            pose = head_in(sample.value)
            if pose is not None:
                drawing.show(pose)
            self._joints.hear(sample, read=pose is not None)
        drawing.show_placeholder(self._joints.placeholder)
        for sample in update.samples.get(LLM_RESULT, ()):
            self._hear(str(sample.value.get("data", "")))
        drawing.show_trouble(*trouble_of(update, HEAD_STATE))

    def _hear(self, text: str) -> None:
        try:
            said: Any = read_json(text)
            if said["event"] == "head":
                drawing = self.query_one(HeadView)
                drawing.command(HeadReading(float(said["pan"]), float(said["tilt"])))
                if "error" in said:
                    drawing.answer(str(said["error"]))
                else:
                    drawing.answer(_("done") if said.get("sum") == 1 else _("refused"))
        except (ValueError, KeyError, TypeError, OverflowError):
            # Anybody may publish there; messages in another format are ignored.
            return
