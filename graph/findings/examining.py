"""All rules together, for one moment."""

from __future__ import annotations

from types import MappingProxyType
from typing import TYPE_CHECKING

from graph.findings import clocks, failed, kinds, publishers, quality, silence, unserved
from graph.findings.finding import GraphNorms

if TYPE_CHECKING:
    from collections.abc import Mapping

    from graph.data import GraphUpdate
    from graph.findings.finding import GraphFinding


def examine(
    update: GraphUpdate, norms: GraphNorms | None = None, failures: Mapping[str, str] = MappingProxyType({})
) -> tuple[GraphFinding, ...]:
    """Return everything that is wrong with the graph now, the worst first.

    `failures`: full name to why, of nodes that have ended for good.

    What messages show (losses, clocks, silence) is only found for topics that are measured.
    """
    norms = norms or GraphNorms()
    found = [
        *publishers.fights(update, norms),
        *publishers.namesakes(update),
        *kinds.disagreements(update),
        *kinds.missing(update),
        *quality.misfits(update),
        *quality.losses(update),
        *unserved.unfed(update, norms, one_has_failed=bool(failures)),
        *unserved.unserved(update),
        *clocks.clocks(update),
        *silence.silences(update, norms),
        *failed.failures(failures),
    ]
    return tuple(sorted(found, key=lambda finding: finding.rank))
