"""What is wrong with a learner's own file, in words: the place, the line itself, what it means."""

from __future__ import annotations

from typing import TYPE_CHECKING

from textual.content import Content

from text.i18n import _, localized
from text.plain import plain

if TYPE_CHECKING:
    from launcher.status import NodeStatus

LONGEST = 400


def fault_lines(node: NodeStatus) -> list[Content]:
    """Return what is wrong with the node: the line of its file, the exception, what it means."""
    fault = node.fault
    if fault is None:
        return []
    place = f"{plain(fault.file.rpartition('/')[2], 80)}:{fault.line}: " if fault.file else ""
    still = _("the process from before still runs")
    still = f" ({still})" if fault.kind == "syntax" and node.state.alive else ""
    goes_on = fault.kind == "warning" and node.state.alive
    sign, colour = ("!", "$text-warning") if goes_on else ("✗", "$text-error")
    lines = [
        Content.assemble(
            (f"{sign} {place}", f"bold {colour}"),
            (plain(localized(fault.exception), LONGEST), colour),
            (still, "$text-muted"),
        )
    ]
    if fault.source_line:
        lines.append(Content.styled(f"    {plain(fault.source_line.strip(), LONGEST)}", "bold"))
    if fault.meaning:
        meaning = plain(localized(fault.meaning), LONGEST)
        lines.append(Content.styled(f"  → {meaning}", "$text-accent"))
    return lines
