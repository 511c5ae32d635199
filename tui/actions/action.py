"""What a user can do: one decorated function each, from which everything else about it is derived.

Key bindings, the footer, the palette, the help page and a user's keymap are made of these. The
functions stand beside the screen that they act on and import it only for its type, so that they
can be listed without it.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from textual.binding import Binding, BindingType
from textual.dom import DOMNode

from tui.actions.layouts import on_all_layouts

Target = TypeVar("Target")
Condition = Callable[[Target], "bool | None"]


def always(_target: object) -> bool:
    return True


@dataclass(frozen=True, eq=False)
class Action(Generic[Target]):
    """Something a user can do to the app, to a screen or to a part of one, which is its `Target`."""

    id: str
    """Binding id, as used in a keymap: `node.restart`."""
    key: str
    """Keys in Textual's notation, comma-separated; the first is the one that is shown.

    Letters are bound on other keyboard layouts, too, see `tui.actions.layouts`.
    """
    title: str
    """Two or three words, marked by `N_`."""
    tooltip: str
    """A sentence, marked by `N_`."""
    do: Callable[[Target], object]
    """Does it; what it returns is awaited if it can be."""
    means: str = ""
    """What its keys do on every screen, for actions that share them; if empty, the title."""
    footer: bool = False
    """Whether the footer shows it."""
    priority: bool = False
    """Whether it comes before the focused widget; a text field keeps the keys it can type.

    An action that focuses a text field needs it: otherwise keys typed right after it would still go
    to the widget that had the focus.
    """
    palette: bool = True
    """Whether the palette offers it where it is possible."""
    anywhere: bool = False
    """Whether the palette runs it from another screen too, rather than only going there.

    Only for actions that change the display and nothing else; others would act on something that
    the user does not see.
    """
    possible: Condition[Target] = always
    """Whether it is possible now; None shows it dimmed, False hides it."""
    pressable: Condition[Target] | None = None
    """The same for its keys; what is not possible may still be run, to say why."""
    shown: Condition[Target] = always
    """Whether the footer shows it now; a hidden key may still say why it cannot act."""
    named: Callable[[Target], str] | None = None
    """Return the title for the footer, if it depends on what the action would do now."""
    module: str = ""
    """Where it is defined; the footer keeps the actions of a module together."""

    def label(self, target: Target) -> str:
        """Return the title for what it would do now."""
        return self.title if self.named is None else self.named(target)

    async def run(self, target: Target) -> None:
        done = self.do(target)
        if inspect.isawaitable(done):
            await done


REGISTRY: dict[str, Action[Any]] = {}
"""Maps a binding id to its action, in the order in which the modules were imported."""


class Announce(Generic[Target]):
    """Makes actions of functions whose target is of one kind: `action: Announce[LogsScreen] = Announce()`."""

    def __call__(  # noqa: PLR0913 - what an action may say
        self,
        id: str,
        key: str,
        title: str,
        tooltip: str,
        *,
        means: str = "",
        footer: bool = False,
        priority: bool = False,
        palette: bool = True,
        anywhere: bool = False,
        when: Condition[Target] = always,
        pressable: Condition[Target] | None = None,
        shown: Condition[Target] = always,
        label: Callable[[Target], str] | None = None,
        module: str = "",
    ) -> Callable[[Callable[[Target], object]], Action[Target]]:
        """Make an action of the function below; what each of these is says `Action`.

        `module` is where it counts as defined, if that is not where the function stands.
        """

        def announce(do: Callable[[Target], object]) -> Action[Target]:
            if id in REGISTRY:
                raise TypeError(f"two actions are called {id!r}")
            made = Action(
                id, key, title, tooltip, do, means, footer, priority, palette, anywhere, when, pressable,
                shown, label, module or do.__module__,
            )  # fmt: skip
            REGISTRY[id] = made
            return made

        return announce


def actions_of(module: str) -> list[Action[Any]]:
    """Return the actions that a module defines, in its order."""
    return [each for each in REGISTRY.values() if each.module == module]


def bindings(*actions: Action[Any]) -> list[BindingType]:
    """Return the key bindings of these actions, for a `BINDINGS`."""
    return [
        Binding(
            on_all_layouts(each.key),
            f"act({each.id!r})",
            each.title,
            show=each.footer,
            tooltip=each.tooltip,
            priority=each.priority,
            id=each.id,
        )
        for each in actions
    ]


def bound(target: DOMNode) -> Iterable[Action[Any]]:
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
        if action != "act":
            return super().check_action(action, parameters)
        asked = REGISTRY[str(parameters[0])]
        return (asked.pressable or asked.possible)(self)
