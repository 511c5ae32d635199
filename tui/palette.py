"""The entries of the palette: actions of all screens, found by their names in either language."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from importlib import import_module
from typing import TYPE_CHECKING, Any

from textual.command import DiscoveryHit, Hit, Hits, Provider

from text.i18n import NAMES, _, in_every_language
from tui.actions import Action, actions_of, bound
from tui.frame.actions.app import SHOW
from tui.frame.actions.replay import REPLAY_ACTIONS
from tui.frame.host import host_of
from tui.screens import SCREENS
from tui.teleop.actions import TELEOP_ACTIONS, open_teleop
from tui.themes import CYCLE
from tui.topics.actions import open_publish
from tui.topics.actions_of_publish import PUBLISH_ACTIONS

if TYPE_CHECKING:
    from textual.app import App
    from textual.dom import DOMNode
    from textual.fuzzy import Matcher
    from textual.screen import Screen

    from tui.frame.host import Host


Actions = Sequence[Action[Any]]
Run = Callable[[], Awaitable[None] | None]

HERE, IMPOSSIBLE, ELSEWHERE = 4.0, 2.0, 1.0
"""Weights of a match: actions that are possible here rank first."""
IN_A_SENTENCE = 0.1
"""Weight of a match in the sentence about an action rather than in its name."""
WORD = 4
"""Sentences are searched only for words of this length: most contain any shorter one."""


@dataclass(frozen=True)
class ActionPlace:
    """Where actions are available: a screen, or a dialog that one of its actions opens."""

    show: Action[Host]
    """Brings the screen to the front."""
    actions: Actions
    opener: Action[Any] | None = None

    @property
    def screen(self) -> str:
        return self.show.id.removeprefix("screen.")

    @property
    def name(self) -> str:
        words = [self.show.title, *([self.opener.title] if self.opener else [])]
        return " › ".join(map(_, words))


def _of_screen(name: str) -> ActionPlace:
    module = f"tui.{SCREENS[name].folder}.actions"
    import_module(module)
    return ActionPlace(SHOW[name], actions_of(module))


PLACES = (
    *map(_of_screen, SHOW),
    ActionPlace(SHOW["deck"], (open_teleop,)),
    ActionPlace(SHOW["deck"], TELEOP_ACTIONS, open_teleop),
    ActionPlace(SHOW["topics"], PUBLISH_ACTIONS, open_publish),
)
"""Every screen of a session, listed without importing any of them: that would delay keys."""


@dataclass(frozen=True)
class PaletteEntry:
    """One entry of the palette."""

    title: str
    """The title as shown, in the current language."""
    names: tuple[str, ...]
    """The texts that it is found by."""
    sentence: str
    run: Run
    about: tuple[str, ...] = ()
    """The sentence in every language."""
    weight: float = HERE
    offered: bool = True
    """Whether it is shown before the user types anything."""

    def score(self, matcher: Matcher) -> float:
        """Return how well it matches the query; 0 if it does not."""
        found = max(map(matcher.match, (self.title, *self.names)))
        if found > 0:
            return found * self.weight
        wanted = matcher.query.casefold()
        told = len(wanted) >= WORD and any(wanted in words.casefold() for words in self.about)
        return IN_A_SENTENCE * self.weight if told else 0.0

    def shown(self, matcher: Matcher) -> str:
        """Return the title, followed by the matching name if that is a different one."""
        if matcher.match(self.title) > 0:
            return self.title
        best = max(self.names, key=matcher.match)
        return f"{self.title} ({best})" if matcher.match(best) > 0 else self.title


def entries(app: App[Any], front: Screen[Any]) -> Iterable[PaletteEntry]:
    """Yield what can be done now, then what is disabled in `front` or belongs to other screens."""
    yield from _possible(front)
    yield from _possible(app)
    for code, name in NAMES.items():
        run = partial(host_of(app).speak, code)
        yield PaletteEntry(name, (name,), _("Use this language."), run)
    for theme in sorted(app.available_themes):
        names = tuple(words.format(name=theme) for words in in_every_language("Theme: {name}"))
        take = partial(setattr, app, "theme", theme)
        words = _("Theme: {name}").format(name=theme)
        yield PaletteEntry(words, names, _("Use these colours."), take, offered=theme in CYCLE)
    yield from _impossible(app, front)
    yield from _impossible(app, app)
    for place in PLACES:
        if place.opener is not None or place.screen != getattr(front, "tab", ""):
            for action in place.actions:
                yield _elsewhere(app, place, action)


def _entry(action: Action[Any], title: str, run: Run, weight: float = HERE) -> PaletteEntry:
    return PaletteEntry(
        title,
        in_every_language(action.title),
        _(action.tooltip),
        run,
        in_every_language(action.tooltip),
        weight,
        offered=weight == HERE,
    )


def _possible(target: DOMNode) -> Iterable[PaletteEntry]:
    for action in bound(target):
        if action.palette and action.possible(target):
            yield _entry(action, _(action.label(target)), run=partial(action.run, target))


def _impossible(app: App[Any], target: DOMNode) -> Iterable[PaletteEntry]:
    for action in bound(target):
        if not action.palette or action.possible(target):
            continue
        if host_of(app).feed.replay is None and action in REPLAY_ACTIONS:
            continue
        title = _("{title} (not possible now)").format(title=_(action.title))
        told = f"{title}. {_(action.tooltip)}"
        yield _entry(action, title, run=partial(_tell, app, told), weight=IMPOSSIBLE)


def _tell(app: App[Any], words: str) -> None:
    app.notify(words, severity="warning")


def _elsewhere(app: App[Any], place: ActionPlace, action: Action[Any]) -> PaletteEntry:
    title = f"{place.name} › {_(action.title)}"
    go = partial(_go, app, place, action)
    return _entry(action, title, run=go, weight=ELSEWHERE)


async def _go(app: App[Any], place: ActionPlace, action: Action[Any]) -> None:
    """Bring the screen of an action to the front, and run the action there if that is safe."""
    if not host_of(app).feed.opened:
        told = _("{title} is on the screen {place}: open a lesson first.")
        _tell(app, told.format(title=_(action.title), place=place.name))
        return
    await host_of(app).show_screen(place.screen)
    app.call_after_refresh(_arrive, app, place, action)


async def _arrive(app: App[Any], place: ActionPlace, action: Action[Any]) -> None:
    front = app.screen
    if front is not app.get_screen(place.screen):
        return
    first = place.opener or action
    possible = bool(first.possible(front))
    # A toggle that is already switched would do the opposite of what was chosen.
    if possible and first.anywhere and first.label(front) == first.title:
        await first.run(front)
        if first is action:
            return
    told = _("{title} is here: {key}.") if possible else _("{title} is here, not possible now.")
    words = told.format(title=_(action.title), key=host_of(app).keys_of(action)[0])
    app.notify(f"{words} {_(action.tooltip)}")


class Commands(Provider):
    """Offers the actions, and says where each of them is."""

    async def discover(self) -> Hits:
        """Yield what is offered before the user types anything."""
        for entry in entries(self.app, self.screen):
            if entry.offered:
                yield DiscoveryHit(entry.title, entry.run, help=entry.sentence)

    async def search(self, query: str) -> Hits:
        """Yield entries that match `query`, or say that there are none."""
        matcher = self.matcher(query)
        found = False
        for entry in entries(self.app, self.screen):
            score = entry.score(matcher)
            if score > 0:
                found = True
                shown = matcher.highlight(entry.shown(matcher))
                yield Hit(score, shown, entry.run, help=entry.sentence)
        if not found:
            yield Hit(0.01, _("Nothing found."), lambda: None)
