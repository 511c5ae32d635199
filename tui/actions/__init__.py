"""What a user can do, and everything derived from it.

An action declares what it needs of its target in a protocol beside it; it imports no screen.
"""

from tui.actions.action import REGISTRY, Acting, Action, bindings, bound
from tui.actions.keys import WRITE_COMMAND, Keys

__all__ = ["REGISTRY", "WRITE_COMMAND", "Acting", "Action", "Keys", "bindings", "bound"]
