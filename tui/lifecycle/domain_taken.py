"""Asks before a second session is started in a domain, where both would hear each other."""

from __future__ import annotations

from enum import Enum
from typing import TYPE_CHECKING, ClassVar

from textual.content import Content

from text.i18n import N_, _, localized
from text.plain import plain
from tui.actions import Announce, bindings
from tui.dialogs.dialog import Dialog

if TYPE_CHECKING:
    from textual.binding import BindingType

    from launcher.errors import DomainTakenError

action: Announce[DomainTakenScreen] = Announce()


class DomainAnswer(Enum):
    """The user's decision."""

    APART = "apart"
    """Start it in the free domain."""
    TOGETHER = "together"
    """Start it in the same domain as the other."""
    NOT = "not"


@action(
    "domain_taken.apart",
    "enter",
    N_("Start in the free domain"),
    N_("Start it in another domain: the two do not hear each other."),
    footer=True,
    palette=False,
)
def start_apart(dialog: DomainTakenScreen) -> None:
    dialog.dismiss(DomainAnswer.APART)


@action(
    "domain_taken.together",
    "s",
    N_("Start beside it"),
    N_("Start it in the same domain: their nodes see and hear each other."),
    means="start",
    footer=True,
    palette=False,
    when=lambda dialog: dialog.taken.can_share,
)
def start_together(dialog: DomainTakenScreen) -> None:
    dialog.dismiss(DomainAnswer.TOGETHER)


@action("domain_taken.not", "escape", N_("Do not start"), N_("Start nothing."), footer=True, palette=False)
def start_not(dialog: DomainTakenScreen) -> None:
    dialog.dismiss(DomainAnswer.NOT)


class DomainTakenScreen(Dialog[DomainAnswer]):
    """Says who is in the domain, and which domain is free."""

    BINDINGS: ClassVar[list[BindingType]] = bindings(start_apart, start_together, start_not)

    def __init__(self, name: str, taken: DomainTakenError) -> None:
        """Ask about starting `name` in a domain that is `taken`."""
        super().__init__()
        self._profile = name
        self.taken: DomainTakenError = taken

    def title_words(self) -> str:
        return _("Domain {domain} is in use").format(domain=self.taken.domain)

    def words(self) -> Content:
        """Say who is there, what that means, and which domain is free."""
        taken = self.taken
        if taken.can_share:
            means = _("In one domain the nodes of both would see and hear each other.")
        else:
            means = _("Both have nodes of the same name, or both drive: one domain is not enough.")
        lines = [
            Content(_("Running there already:")),
            *(Content.styled(plain(localized(one), 300), "bold") for one in taken.sessions),
            Content(""),
            Content(means),
            Content(
                _("Domain {free} is free: {name} can start in it.").format(free=taken.free, name=plain(self._profile))
            ),
        ]
        return Content("\n").join(lines)
