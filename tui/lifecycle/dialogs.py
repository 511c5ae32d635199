"""The dialogs that ask and tell something when a session is opened or closed."""

from __future__ import annotations

from enum import Enum
from typing import TYPE_CHECKING, Any, ClassVar

from textual.content import Content

from text.i18n import N_, _, localized, ngettext
from text.plain import plain
from tui.actions import Announce, bindings
from tui.dialogs.dialog import Dialog, answers
from tui.session.words import started_words
from tui.widgets.node_words import STATES, why

if TYPE_CHECKING:
    from textual.binding import BindingType

    from launcher.errors import DomainTakenError
    from launcher.status import SessionInfo, Stray

action: Announce[Any] = Announce()


class DomainAnswer(Enum):
    """What to do about a domain that is taken."""

    APART = "apart"
    """Start it in the free domain."""
    TOGETHER = "together"
    """Start it in the same domain as the other."""
    NOT = "not"


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


class DomainTakenScreen(Dialog[DomainAnswer]):
    """Asks before a second session is started in a domain, where both would hear each other."""

    BINDINGS: ClassVar[list[BindingType]] = [
        *answers(
            (
                "domain_taken.apart",
                "enter",
                N_("Start in the free domain"),
                N_("Start it in another domain: the two do not hear each other."),
                DomainAnswer.APART,
            )
        ),
        *bindings(start_together),
        *answers(("domain_taken.not", "escape", N_("Do not start"), N_("Start nothing."), DomainAnswer.NOT)),
    ]

    def __init__(self, name: str, taken: DomainTakenError) -> None:
        """Ask about starting `name` in a domain that is `taken`."""
        super().__init__()
        self._profile = name
        self.taken: DomainTakenError = taken

    def title_words(self) -> str:
        return _("Domain {domain} is in use").format(domain=self.taken.domain)

    def words(self) -> Content:
        taken = self.taken
        means = _("Both have nodes of the same name, or both drive: one domain is not enough.")
        if taken.can_share:
            means = _("In one domain the nodes of both would see and hear each other.")
        free = _("Domain {free} is free: {name} can start in it.")
        lines = [
            Content(_("Running there already:")),
            *(Content.styled(plain(localized(one), 300), "bold") for one in taken.sessions),
            Content(""),
            Content(means),
            Content(free.format(free=taken.free, name=plain(self._profile))),
        ]
        return Content("\n").join(lines)


class EndSessionScreen(Dialog[bool]):
    """Asks before stopping a session that was started elsewhere: whose it is, and what will stop."""

    BINDINGS: ClassVar[list[BindingType]] = answers(
        (
            *("end_session.end", "enter"),
            *(N_("End it"), N_("Stop all of its nodes, dependants first, and the session."), True),
        ),
        ("end_session.leave", "escape", N_("Let it run"), N_("Back to the session as it is."), False),
    )

    def __init__(self, session: SessionInfo) -> None:
        super().__init__()
        self._session = session

    def title_words(self) -> str:
        return _("End what was started elsewhere?")

    def words(self) -> Content:
        session, count = self._session, len(self.deck.feed.nodes)
        ends = ngettext(
            "Its {n} node will be stopped. Every screen that shows it will say that you ended it.",
            "Its {n} nodes will be stopped. Every screen that shows it will say that you ended it.",
            count,
        )
        lines = [
            Content.styled(plain(session.name), "bold"),
            Content(_("domain {domain}").format(domain=session.domain)),
            Content(started_words(session)),
            Content(""),
            Content(ends.format(n=count)),
        ]
        return Content("\n").join(lines)


class RefusedScreen(Dialog[None]):
    """Says why a lesson could not be opened, one line for each problem."""

    BINDINGS: ClassVar[list[BindingType]] = answers(
        ("refused.close", "escape,enter", N_("Close"), N_("Go back to the list of lessons."), None)
    )

    def __init__(self, reason: str) -> None:
        super().__init__()
        self._reason = reason

    def title_words(self) -> str:
        return _("It could not be opened")

    def words(self) -> Content:
        return Content("\n".join(plain(line) for line in self._reason.splitlines()))


@action(
    "stopping.now",
    "q,ctrl+q,ctrl+c",
    N_("Stop at once"),
    N_("Kill what has not stopped yet."),
    means="leave",
    footer=True,
    priority=True,
    palette=False,
)
def stop_now(dialog: StoppingScreen) -> None:
    dialog.deck.sessions.stop_now()


class StoppingScreen(Dialog[None]):
    """The nodes that are still running while they are being stopped, and why; updated a few times a second."""

    BINDINGS: ClassVar[list[BindingType]] = bindings(stop_now)
    can_be_covered = False

    def on_mount(self) -> None:
        self.set_interval(0.2, self.redraw)

    def title_words(self) -> str:
        return _("Stopping the nodes")

    def words(self) -> Content:
        alive = [node for node in self.deck.feed.nodes.values() if node.state.alive]
        if not alive:
            return Content(_("All nodes have stopped."))
        lines = [Content(_("Dependants first; each has a few seconds to end by itself."))]
        for node in alive:
            sign, word, _meaning = STATES[node.state]
            state = (f"{sign} {_(word):<14}", "$text-warning")
            lines.append(Content.assemble(state, (plain(node.name), "bold"), (f"  {why(node)}", "$text-muted")))
        return Content("\n").join(lines)


class StraysScreen(Dialog[bool]):
    """Offers to stop processes that an earlier run left behind."""

    BINDINGS: ClassVar[list[BindingType]] = answers(
        ("strays.stop", "enter", N_("Stop them"), N_("Stop what an earlier run has left behind."), True),
        ("strays.leave", "escape", N_("Leave them"), N_("Leave them running; they may disturb this session."), False),
    )

    def __init__(self, strays: tuple[Stray, ...]) -> None:
        super().__init__()
        self._strays = strays

    def title_words(self) -> str:
        return _("Left behind by an earlier run")

    def words(self) -> Content:
        words = ngettext(
            "{n} process of an earlier run is still alive and may disturb this one:",
            "{n} processes of an earlier run are still alive and may disturb this one:",
            len(self._strays),
        )
        lines = [Content(words.format(n=len(self._strays)))]
        for stray in self._strays:
            process, command = f"{stray.pid:>8}  ", f"  {plain(stray.command, 200)}"
            lines.append(
                Content.assemble((process, "$text-muted"), (plain(stray.node, 60), "bold"), (command, "$text-muted"))
            )
        return Content("\n").join(lines)
