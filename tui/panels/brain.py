"""The robot's brain: whether it thinks with a model or by rules, and what its answers take."""

from __future__ import annotations

from graph.data import GraphUpdate
from robot.topics import BRAIN_STATE
from text.i18n import N_
from tui.log_view.index import folded
from tui.outcome.model_usage import BrainReport, brain_reports, budget_words, usage_words
from tui.panels.panel import Panel, newest, other_type, trouble_of
from tui.widgets.drawing import Drawing, Ink, Line

TYPE = "diagnostic_msgs/msg/DiagnosticArray"
LOOKS = {0: "good", 1: "muted"}
"""Of a report's level; more severe ones are faults."""
MOST_NODES = 8


class BrainView(Drawing):
    """The reports of the nodes that may ask a model, one below the other."""

    def __init__(self) -> None:
        super().__init__()
        self._reports: dict[str, BrainReport] = {}

    def hear(self, report: BrainReport) -> None:
        if report.node in self._reports or len(self._reports) < MOST_NODES:
            self._reports[report.node] = report
            self.redraw()

    @property
    def has_value(self) -> bool:
        return bool(self._reports)

    def draw(self, width: int, height: int) -> list[Line]:
        reports = [self._reports[name] for name in sorted(self._reports)]
        several = len(reports) > 1
        parts = [
            (f"{one.node}: {one.message}" if several else one.message, LOOKS.get(one.level, "bad")) for one in reports
        ]
        parts += [
            # The state usually names the model.
            (usage_words(one.usage, named=one.model not in one.message), "")
            for one in reports
            if one.usage is not None
        ]
        budgets = [one.budget for one in reports if one.budget is not None]
        if budgets:
            # All share one; the report with the most of it is the newest.
            parts.append((budget_words(max(budgets, key=lambda one: one.tokens)), "muted"))
        return [[Ink(row, look)] for text, look in parts for row in folded(text, width)][:height]


class BrainPanel(Panel):
    """What /brain_state says."""

    view = BrainView
    title = N_("Brain")
    least = 2
    weight = 2
    across_below = 80

    def useful(self, rows: int) -> int:
        """State, the last answer and the budget."""
        return min(rows, 3)

    def followed(self) -> set[str]:
        """Every report: several nodes write there."""
        return {BRAIN_STATE}

    def show(self, update: GraphUpdate) -> None:
        view = self.query_one(BrainView)
        for sample in update.samples.get(BRAIN_STATE, ()):
            if sample.type_name == TYPE:
                for report in brain_reports(sample):
                    view.hear(report)
        if BRAIN_STATE in update.samples:
            view.show_placeholder(other_type(newest(update, BRAIN_STATE), TYPE))
        view.show_trouble(*trouble_of(update, BRAIN_STATE))
