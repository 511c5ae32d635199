"""What a user can do, and everything derived from it.

An action imports the screen that it acts on only for its type.
"""

from tui.actions.action import REGISTRY, Acting, Action, Announce, actions_of, bindings, bound
from tui.actions.keys import WRITE_COMMAND, Keys

__all__ = ["REGISTRY", "WRITE_COMMAND", "Acting", "Action", "Announce", "Keys", "actions_of", "bindings", "bound"]
