"""The palette's contents: what can be done on any screen, found by its name in either language."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Iterable
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

from textual.command import DiscoveryHit, Hit, Hits, Provider

from text.i18n import NAMES, _, in_every_language
from tui.actions import Action, bound
from tui.composer.actions import COMPOSER_ACTIONS
from tui.deck.actions import DECK_ACTIONS
from tui.devices.actions import DEVICES_ACTIONS
from tui.flow.actions import FLOW_ACTIONS
from tui.frame.actions.app import (
    ShowComposer,
    ShowDeck,
    ShowDevices,
    ShowFlow,
    ShowGraph,
    ShowLogs,
    ShowScreen,
    ShowTopics,
)
from tui.frame.actions.replay import ReplayAction
from tui.frame.host import host_of
from tui.graph.actions import GRAPH_ACTIONS
from tui.logs.actions import LOGS_ACTIONS
from tui.teleop.actions import TELEOP_ACTIONS, OpenTeleop
from tui.themes import CYCLE
from tui.topics.actions import TOPICS_ACTIONS, OpenPublish
from tui.topics.publish.actions import PUBLISH_ACTIONS

if TYPE_CHECKING:
    from textual.app import App
    from textual.dom import DOMNode
    from textual.fuzzy import Matcher
    from textual.screen import Screen


Actions = tuple[type[Action[Any]], ...]
Run = Callable[[], Awaitable[None] | None]

HERE, IMPOSSIBLE, ELSEWHERE = 4.0, 2.0, 1.0
"""By how much a name counts more where it can be done at once."""
IN_A_SENTENCE = 0.1
"""What a word counts that stands in the sentence about an action, not in its name."""
WORD = 4
"""How many letters are looked for in sentences: fewer stand in most of them."""


@dataclass(frozen=True)
class ActionPlace:
    """Where actions are: a screen, or what one of its actions opens there."""

    show: type[ShowScreen]
    actions: Actions
    opener: type[Action[Any]] | None = None

    @property
    def name(self) -> str:
        """How it is called in the language spoken now."""
        words = [self.show.title, *([self.opener.title] if self.opener else [])]
        return " › ".join(map(_, words))


PLACES = (
    ActionPlace(ShowDeck, (*DECK_ACTIONS, OpenTeleop)),
    ActionPlace(ShowDeck, TELEOP_ACTIONS, OpenTeleop),
    ActionPlace(ShowTopics, TOPICS_ACTIONS),
    ActionPlace(ShowTopics, PUBLISH_ACTIONS, OpenPublish),
    ActionPlace(ShowComposer, COMPOSER_ACTIONS),
    ActionPlace(ShowLogs, LOGS_ACTIONS),
    ActionPlace(ShowGraph, GRAPH_ACTIONS),
    ActionPlace(ShowFlow, FLOW_ACTIONS),
    ActionPlace(ShowDevices, DEVICES_ACTIONS),
)
"""Every screen of a session, told without importing any of them: that would hold the keys up."""


@dataclass(frozen=True)
class PaletteEntry:
    """One thing that the palette offers."""

    title: str
    """As it is shown, in the language spoken now."""
    names: tuple[str, ...]
    """What it is found by."""
    sentence: str
    run: Run
    about: tuple[str, ...] = ()
    """The sentence in every language."""
    weight: float = HERE
    offered: bool = True
    """Whether it is shown before anything is typed."""

    def score(self, matcher: Matcher) -> float:
        """Return how well it is called what is looked for; 0 if it is not."""
        found = max(map(matcher.match, (self.title, *self.names)))
        if found > 0:
            return found * self.weight
        wanted = matcher.query.casefold()
        told = len(wanted) >= WORD and any(wanted in words.casefold() for words in self.about)
        return IN_A_SENTENCE * self.weight if told else 0.0

    def shown(self, matcher: Matcher) -> str:
        """Return the title, with the name that was found behind it if it is another one."""
        if matcher.match(self.title) > 0:
            return self.title
        best = max(self.names, key=matcher.match)
        return f"{self.title} ({best})" if matcher.match(best) > 0 else self.title


def entries(app: App[Any], front: Screen[Any]) -> Iterable[PaletteEntry]:
    """Yield what can be done now, then what is impossible in `front` now, or is done elsewhere."""
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
        if place.opener is not None or place.show.screen != getattr(front, "tab", ""):
            for action in place.actions:
                yield _elsewhere(app, place, action)


def _entry(action: type[Action[Any]], title: str, run: Run, weight: float = HERE) -> PaletteEntry:
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
        if host_of(app).feed.replay is None and issubclass(action, ReplayAction):
            continue
        title = _("{title} (not possible now)").format(title=_(action.title))
        told = f"{title}. {_(action.tooltip)}"
        yield _entry(action, title, run=partial(_tell, app, told), weight=IMPOSSIBLE)


def _tell(app: App[Any], words: str) -> None:
    app.notify(words, severity="warning")


def _elsewhere(app: App[Any], place: ActionPlace, action: type[Action[Any]]) -> PaletteEntry:
    title = f"{place.name} › {_(action.title)}"
    go = partial(_go, app, place, action)
    return _entry(action, title, run=go, weight=ELSEWHERE)


async def _go(app: App[Any], place: ActionPlace, action: type[Action[Any]]) -> None:
    """Bring the screen of an action to the front, and there do it if nothing can go wrong."""
    if not host_of(app).feed.opened:
        told = _("{title} is on the screen {place}: open a lesson first.")
        _tell(app, told.format(title=_(action.title), place=place.name))
        return
    await host_of(app).show_screen(place.show.screen)
    app.call_after_refresh(_arrive, app, place, action)


async def _arrive(app: App[Any], place: ActionPlace, action: type[Action[Any]]) -> None:
    front = app.screen
    if front is not app.get_screen(place.show.screen):
        return
    first = place.opener or action
    possible = bool(first.possible(front))
    # A switch that stands the other way round would do the opposite of what was chosen.
    if possible and first.from_elsewhere and first.label(front) == first.title:
        await first.run(front)
        if first is action:
            return
    told = _("{title} is here: {key}.") if possible else _("{title} is here, not possible now.")
    words = told.format(title=_(action.title), key=host_of(app).keys_of(action)[0])
    app.notify(f"{words} {_(action.tooltip)}")


class Commands(Provider):
    """Offers what can be done, and says where."""

    async def discover(self) -> Hits:
        """Yield what is offered before anything is typed."""
        for entry in entries(self.app, self.screen):
            if entry.offered:
                yield DiscoveryHit(entry.title, entry.run, help=entry.sentence)

    async def search(self, query: str) -> Hits:
        """Yield what is called something like `query`, or say that nothing is."""
        matcher = self.matcher(query)
        found = False
        for entry in entries(self.app, self.screen):
            score = entry.score(matcher)
            if score > 0:
                found = True
                shown = matcher.highlight(entry.shown(matcher))
                yield Hit(score, shown, entry.run, help=entry.sentence)
        if not found:
            yield Hit(0.01, _("Nothing has that name."), lambda: None)
