"""The palette's contents: everything that can be done now, found by its name."""

from __future__ import annotations

from textual.command import DiscoveryHit, Hit, Hits, Provider

from tui.i18n import _


class Commands(Provider):
    """Offers what the app says is possible on the screen below the palette."""

    async def discover(self) -> Hits:
        """Yield what is offered before anything is typed."""
        for name, tooltip, run, offered in self.app.get_system_commands(self.screen):
            if offered:
                yield DiscoveryHit(name, run, help=tooltip)

    async def search(self, query: str) -> Hits:
        """Yield what is called something like `query`, or say that nothing is."""
        matcher = self.matcher(query)
        found = False
        for name, tooltip, run, _offered in self.app.get_system_commands(self.screen):
            score = matcher.match(name)
            if score > 0:
                found = True
                yield Hit(score, matcher.highlight(name), run, help=tooltip)
        if not found:
            yield Hit(0.01, _("Nothing is called that."), lambda: None)
