"""What a person can do, and all that derives from it."""

from tui.actions.action import REGISTRY, Acting, Action, bindings, bound

__all__ = ["REGISTRY", "Acting", "Action", "bindings", "bound"]
