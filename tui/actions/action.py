"""What a user can do: one class for each action, from which everything else about it is derived.

Key bindings, the footer, the palette, the help page and a user's keymap are made of these.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, ClassVar, Generic, TypeVar

from textual.binding import Binding, BindingType
from textual.dom import DOMNode

from tui.actions.layouts import on_all_layouts

Target = TypeVar("Target")

REGISTRY: dict[str, type[Action[Any]]] = {}
"""Maps a binding id to its action, in the order in which the modules were imported."""


class Action(Generic[Target]):
    """Something a user can do to the app or to a screen, which is its `Target`."""

    id: ClassVar[str]
    """Binding id, as used in a keymap: `node.restart`."""
    key: ClassVar[str]
    """Keys in Textual's notation, comma-separated; the first is the one that is shown."""
    title: ClassVar[str]
    """Two or three words, marked by `N_`."""
    tooltip: ClassVar[str]
    """A sentence, marked by `N_`."""
    means: ClassVar[str] = ""
    """What its keys do on every screen, for actions that share them; if empty, the title."""
    footer: ClassVar[bool] = False
    """Whether the footer shows it."""
    priority: ClassVar[bool] = False
    """Whether it comes before the focused widget; a text field keeps the keys it can type.

    An action that focuses a text field needs it: otherwise keys typed right after it would still go
    to the widget that had the focus.
    """
    palette: ClassVar[bool] = True
    """Whether the palette offers it where it is possible."""
    from_elsewhere: ClassVar[bool] = False
    """Whether the palette runs it from another screen too, rather than only going there.

    Only for actions that change the display and nothing else; others would act on something that
    the user does not see.
    """

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        if "id" in cls.__dict__:
            if cls.id in REGISTRY:
                raise TypeError(f"two actions are called {cls.id!r}")
            REGISTRY[cls.id] = cls

    @classmethod
    def possible(cls, target: Target) -> bool | None:
        """Return whether the action is possible now; None shows it dimmed, False hides it."""
        del target
        return True

    @classmethod
    def pressable(cls, target: Target) -> bool | None:
        """Return the same for its keys; what is not possible may still be run, to say why."""
        return cls.possible(target)

    @classmethod
    def shown(cls, target: Target) -> bool:
        """Return whether the footer shows it now; a hidden key may still say why it cannot act."""
        del target
        return True

    @classmethod
    def label(cls, target: Target) -> str:
        """Return the title for the footer, which may depend on what the action would do now."""
        del target
        return cls.title

    @classmethod
    async def run(cls, target: Target) -> None:
        raise NotImplementedError


def bindings(*actions: type[Action[Any]]) -> list[BindingType]:
    """Return the key bindings of these actions, for a `BINDINGS`."""
    return [
        Binding(
            on_all_layouts(action.key),
            f"act({action.id!r})",
            action.title,
            show=action.footer,
            tooltip=action.tooltip,
            priority=action.priority,
            id=action.id,
        )
        for action in actions
    ]


def bound(target: DOMNode) -> Iterable[type[Action[Any]]]:
    """Yield the actions that `target` binds, in order."""
    seen: set[str] = set()
    for _key, binding in target._bindings:  # noqa: SLF001 - the public view merges the screen's
        if binding.id in REGISTRY and binding.id not in seen:
            seen.add(binding.id)
            yield REGISTRY[binding.id]


class Acting(DOMNode):
    """Mixin of the app and the screens, used as the last base: runs the actions they bind.

    Textual takes style sheets and component classes only from the first base.
    """

    async def action_act(self, action_id: str) -> None:
        """Run the action called `action_id`."""
        await REGISTRY[action_id].run(self)

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        """Ask the action whether it is possible now."""
        if action == "act":
            return REGISTRY[str(parameters[0])].pressable(self)
        return super().check_action(action, parameters)
