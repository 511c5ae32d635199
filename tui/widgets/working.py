"""What a widget still works on ends before the widget goes."""

from __future__ import annotations

from typing import TYPE_CHECKING

from textual.dom import DOMNode

if TYPE_CHECKING:
    from textual.messages import Prune


class Working(DOMNode):
    """Mixed, as the last base, into what has workers that come back to its children.

    Textual takes the children away first and cancels the workers of their parent after that. A
    worker that came back in between would look for children that are gone, and end the program.
    """

    def _on_prune(self, _event: Prune) -> None:
        """Give up, as long as the children are there."""
        self.workers.cancel_node(self)
