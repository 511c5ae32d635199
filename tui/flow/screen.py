"""One log across nodes: what followed from an utterance, and after how long."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, ClassVar

from textual import on
from textual.content import Content
from textual.style import Style
from textual.widgets import Static

from robot.topics import BRAIN_STATE
from text import ros2_words
from text.i18n import N_, _, localized, ngettext
from tui import clock
from tui.actions import WRITE_COMMAND, bindings
from tui.flow import words
from tui.flow.actions import FLOW_ACTIONS
from tui.flow.chains import FlowBook, Lane
from tui.flow.reading import TOPICS, FlowReader, log_steps
from tui.frame.screen import DeckScreen
from tui.widgets.rows import Rows

if TYPE_CHECKING:
    from collections.abc import Sequence

    from textual.app import ComposeResult

    from graph.data import GraphUpdate
    from tui.flow.chains import Chain, FlowStep
    from tui.session.messages import GraphChanged, LanguageChanged, LogArrived, SessionChanged


class FlowScreen(DeckScreen):
    """The lanes, the chains, and the full text of the chosen step."""

    tab: ClassVar[str] = "flow"
    parts: ClassVar[tuple[str, ...]] = ("#flow-view",)
    about: ClassVar[str] = N_(
        "What followed when somebody spoke into the microphone, or sent a command: every message "
        "and log line with its delay from the first and from the step before. The newest utterance "
        "is at the top; Enter folds one. What is repeated all the time is shown when it changes. "
        "What came since the session was opened is here, whatever screen was in front."
    )
    period_s = 0.1
    BINDINGS: ClassVar = bindings(*FLOW_ACTIONS)
    DEFAULT_CSS = """
    FlowScreen {
        #flow-lanes { height: auto; max-height: 2; padding: 0 1; background: $panel;
            link-style: none; link-color: $foreground; link-background: transparent;
            link-style-hover: reverse;
        }
        #flow-empty { height: 1fr; padding: 1 2; color: $text-muted; }
        #flow-step { height: auto; max-height: 4; padding: 0 1; border-top: solid $panel; }
    }
    """

    def __init__(self) -> None:
        super().__init__()
        self.paused: bool = False
        self._book, self._reader = FlowBook(), FlowReader()
        self._hidden = {Lane.LOG}
        self._has_agents = False
        """Whether an agent has called anything: only then is there a lane for it."""
        self._folded: set[float] = set()
        self._held: tuple[Chain, ...] = ()
        """The chains shown while paused."""
        self._steps: dict[str, tuple[Chain, FlowStep | None]] = {}
        """Maps the key of a row to its chain and step; of a headline to the first step."""
        self._update: GraphUpdate | None = None
        self._since_s: float | None = None
        """Unix time (of the recording in a replay) before which nothing was collected."""

    def compose_body(self) -> ComposeResult:
        yield Static(id="flow-lanes", markup=False)
        yield Static(id="flow-empty", markup=False)
        yield Rows(id="flow-view")
        yield Static(id="flow-step", markup=False)

    @property
    def view(self) -> Rows:
        return self.query_one("#flow-view", Rows)

    @property
    def chains(self) -> Sequence[Chain]:
        """The chains shown, newest first."""
        return self._held if self.paused else tuple(reversed(self._book.chains))

    @property
    def chosen_chain(self) -> Chain | None:
        found = self._steps.get(self.view.chosen) if self.is_mounted else None
        return None if found is None else found[0]

    @property
    def chosen_step(self) -> FlowStep | None:
        """The step at the cursor; the first one of the chain if that is a headline."""
        found = self._steps.get(self.view.chosen) if self.is_mounted else None
        return None if found is None else found[1]

    def follow_topics(self) -> set[str]:
        return set(TOPICS)

    def past_topics(self) -> set[str]:
        return set(TOPICS)

    def on_mount(self) -> None:
        self._show()

    def on_resize(self) -> None:
        self.call_after_refresh(self._show)

    def on_session_changed(self, message: SessionChanged) -> None:
        """Start a new session with nothing; keep what is shown of a session that has ended."""
        del message
        if self.feed.session is not None:
            self._book.clear()
            self._reader = FlowReader()
            self._since_s = None
            self.paused = False
            self._show()

    def on_log_arrived(self, message: LogArrived) -> None:
        steps = log_steps(message.lines, self.feed.nodes)
        self._has_agents = self._has_agents or any(step.lane is Lane.AGENT for step in steps)
        self._take(steps)

    def on_graph_changed(self, message: GraphChanged) -> None:
        update = self._update = message.update
        came = [one.received_s for topic in TOPICS for one in update.samples.get(topic, ())[:1]]
        # Time may go back: somebody jumped back in a recording.
        if (since_s := min(came, default=math.inf)) < (math.inf if self._since_s is None else self._since_s):
            self._since_s = since_s
            self._say_lanes()
        said_by = {
            row.name: ", ".join(dict.fromkeys(localized(end.called) for end in row.published_by))
            for row in update.topics
            if row.name in TOPICS
        }
        if not self._take(self._reader.messages(update.samples, said_by)):
            self._say_empty()

    def on_language_changed(self, message: LanguageChanged) -> None:
        del message
        self._show()

    @on(Rows.Highlighted, "#flow-view")
    def _highlighted(self) -> None:
        self._say_step()
        self.refresh_bindings()

    @on(Rows.Opened, "#flow-view")
    def _fold(self) -> None:
        chain = self.chosen_chain
        if chain is not None:
            self._folded ^= {chain.start_s}
            self.view.choose(words.key_of(chain))
            self._show()

    # Actions

    async def ros2_command(self) -> str:
        step = self.chosen_step
        if step is None or step.lane is Lane.AGENT:
            return ""
        if step.source.startswith("/") and step.lane is not Lane.LOG:
            return ros2_words.echo(step.source)
        return ros2_words.log_of(step.source)

    def neighbour(self, step: int) -> Chain | None:
        chains, chosen = list(self.chains), self.chosen_chain
        at = chains.index(chosen) + step if chosen in chains and chosen is not None else -1
        return chains[at] if 0 <= at < len(chains) else None

    def go(self, step: int) -> None:
        chain = self.neighbour(step)
        if chain is not None:
            self.view.choose(words.key_of(chain))

    def toggle_pause(self) -> None:
        self._held = () if self.paused else tuple(reversed(self._book.chains))
        self.paused = not self.paused
        self._show()

    def toggle_lane(self, lane: Lane) -> None:
        """Show the steps of this lane, or hide them."""
        self._hidden ^= {lane}
        self._show()

    def action_lane(self, lane: str) -> None:
        self.toggle_lane(Lane(lane))

    def show_all(self) -> None:
        self._hidden = {Lane.LOG}
        self._show()

    def copy_chain(self) -> None:
        chain = self.chosen_chain
        if chain is None:
            return
        shown = self._shown(chain)
        rows = [
            f"{words.delay(chain.delay_s(step)):>10}  {step.source:<20}  "
            f"{words.said_by(step, chain):<24}  {words.content_words(step)}"
            for step in shown
        ]
        head = filter(None, (words.headline(chain, shown), words.model_took(chain)))
        self.app.copy_to_clipboard("\n".join([*head, *rows]) + "\n")
        count = len(rows)
        told = ngettext("Copied {n} step", "Copied {n} steps", count).format(n=count)
        self.notify(told, markup=False)

    # Display

    def _take(self, steps: Sequence[FlowStep]) -> bool:
        """Add steps to their chains; return whether anything visible has changed."""
        if not steps or not self._book.add(steps):
            return False
        if self.paused:
            self._say_lanes()
        else:
            self._show()
        return True

    def _shown(self, chain: Chain) -> list[FlowStep]:
        # What an answer took stands in the headline, not among what happened.
        return [step for step in chain.steps if step.lane not in self._hidden and step.source != BRAIN_STATE]

    def _show(self) -> None:
        """Show everything; at the top, follow what is new, otherwise stay at the chosen row."""
        if not self.is_mounted:
            return
        follows = self.view.chosen in ("", next(iter(self._steps), ""))
        width, rows = self.size.width, []
        self._steps = {}
        for chain in self.chains:
            shown, folded = self._shown(chain), chain.start_s in self._folded
            at = clock.time_of_day(chain.start_s)
            rows += words.rows_of(chain, at, shown, width, folded=folded)
            self._steps[words.key_of(chain)] = chain, shown[0] if shown else None
            if not folded:
                self._steps |= {words.key_of(chain, n): (chain, step) for n, step in enumerate(shown)}
        self.view.show(words.columns(width), rows)
        if follows and self._steps:
            self.view.choose(next(iter(self._steps)))
        self._say_lanes()
        self._say_empty()
        self._say_step()
        self.refresh_bindings()

    def _say_lanes(self) -> None:
        pieces = [self._lanes()]
        if self.paused:
            waiting = len(self._book.chains) - len(self._held)
            more = f" +{waiting}" if waiting > 0 else ""
            pieces.append(Content.styled(_("paused") + more, "bold"))
        if self._since_s is not None:
            since = _("collected since {time}").format(time=clock.time_of_day(self._since_s))
            pieces.append(Content.styled(since, "dim"))
        self.query_one("#flow-lanes", Static).update(Content("  ").join(pieces))

    def _lanes(self) -> Content:
        """Return marks and names, closer together where no mark would stay beside its name."""
        labels = []
        for lane, name in words.LANES.items():
            if lane is Lane.AGENT and not self._has_agents:
                continue
            mark = "○" if lane in self._hidden else "●"
            click = Style.from_meta({"@click": f"screen.lane({lane.value!r})"})
            labels.append(Content.styled(f"{mark} {_(name)}", click))
        wide = Content("  ").join(labels)
        room = self.query_one("#flow-lanes").content_size.width
        return wide if wide.cell_length <= room else Content(" ").join(labels)

    def _say_empty(self) -> None:
        empty = not self.chains
        self.view.display = not empty
        self.query_one("#flow-step").display = not empty
        note = self.query_one("#flow-empty", Static)
        note.display = empty
        if not empty and self.focused is None:
            self.view.focus()
        if empty:
            rows = () if self._update is None else self._update.topics
            there = {row.name for row in rows if row.publishers or row.subscribers}
            key, recorded = self.deck.keys_of(WRITE_COMMAND)[0], self.feed.replay is not None
            note.update("\n".join(words.nothing_yet(there, key, recorded=recorded)))

    def _say_step(self) -> None:
        chain, step = self.chosen_chain, self.chosen_step
        if chain is None or step is None:
            return
        by = words.said_by(step, chain)
        head = f"{words.delay(chain.delay_s(step))} · {step.source}"
        head += f" · {by}" if by and by != step.source else ""
        self.query_one("#flow-step", Static).update(f"{head}\n{words.content_words(step)}")
