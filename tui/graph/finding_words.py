"""The findings of the graph on the screen: which are shown now, and in which words."""

from __future__ import annotations

from typing import TYPE_CHECKING

from graph.findings.finding import FindingLevel
from graph.findings.rules import LastingFindings
from launcher.status import NodeState
from text.i18n import N_, _
from tui import clock
from tui.session.bypass import NORMS

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from graph.data import GraphUpdate
    from graph.findings.finding import GraphFinding
    from launcher.status import NodeStatus

LOOKS = {FindingLevel.ERROR: ("✗", N_("error"), "bad"), FindingLevel.WARNING: ("▲", N_("warning"), "warn")}
"""Sign, word and meaning (`tui.widgets.rows.Cell`) of a level."""
_TITLES = {
    "clock": N_("another clock"),
    "failed": N_("has failed"),
    "clock-mix": N_("two kinds of time"),
    "fight": N_("publishers that fight"),
    "lost": N_("messages are lost"),
    "namesakes": N_("nodes with one name"),
    "near-name": N_("name nearly matches"),
    "no-clock": N_("no simulated time"),
    "qos": N_("incompatible QoS"),
    "silent": N_("has fallen silent"),
    "two-types": N_("types do not agree"),
    "unfed": N_("nobody publishes"),
    "unknown-type": N_("unknown type"),
    "unserved": N_("nobody serves"),
}


def failures_of(nodes: Iterable[NodeStatus]) -> dict[str, str]:
    """Return the nodes that have ended for good, by full name, and why."""
    return {f"/{node.name}": node.detail for node in nodes if node.state is NodeState.FAILED}


def title(finding: GraphFinding) -> str:
    """Return two or three words for what is wrong."""
    return _(_TITLES[finding.rule])


def head_words(finding: GraphFinding) -> str:
    """Return how bad it is and what it is: `✗ error · nobody serves`."""
    sign, word, _meaning = LOOKS[finding.level]
    return f"{sign} {_(word)} · {title(finding)}"


def checked_words() -> str:
    """Return what was looked for where nothing was found."""
    return _(
        "Checked: publishers that fight, types that do not agree, QoS, topics and services without "
        "a source, names that nearly match, nodes with one name, clocks. While this list is open, "
        "every topic is measured: lost messages, foreign stamps and silence show up, too."
    )


class FindingsBook:
    """What is wrong with the graph now, once it has held for long enough."""

    def __init__(self) -> None:
        self.told: tuple[GraphFinding, ...] = ()
        """The worst first."""
        self._lasting = LastingFindings(NORMS)

    @property
    def worst(self) -> str:
        """The meaning of the worst one, empty if there are none."""
        return LOOKS[self.told[0].level][2] if self.told else ""

    def take(self, update: GraphUpdate | None, failures: Mapping[str, str]) -> None:
        """Examine this graph; None if the session has ended. `failures`: see `examine`."""
        if update is None:
            self._lasting.forget()
        else:
            self._lasting.take(update, clock.steady(), failures)
        self.settle()

    def settle(self) -> bool:
        """Tell what has held for long enough by now; return whether anything has changed."""
        before, self.told = self.told, self._lasting.told(clock.steady())
        return before != self.told

    def get(self, key: str) -> GraphFinding | None:
        """Return the finding with this key, if it still holds."""
        return next((one for one in self.told if one.key == key), None)
