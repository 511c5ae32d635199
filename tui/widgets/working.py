"""Ends the workers of a widget before the widget is removed."""

from __future__ import annotations

from textual.dom import DOMNode
from textual.messages import Prune


class Working(DOMNode):
    """Mixin, to be used as the last base, for a widget whose workers access its children.

    Textual removes the children first and cancels the workers of their parent afterwards. A worker
    that continued in between would look for children that are gone, and end the program.
    """

    def _on_prune(self, _event: Prune) -> None:
        """Cancel the workers while the children still exist."""
        self.workers.cancel_node(self)
