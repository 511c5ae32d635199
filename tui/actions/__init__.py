"""What a user can do, and everything derived from it.

An action says what it needs of its target by a protocol beside it; it imports no screen.
"""

from tui.actions.action import REGISTRY, Acting, Action, bindings, bound

__all__ = ["REGISTRY", "Acting", "Action", "bindings", "bound"]
