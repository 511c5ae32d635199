"""What agents ask for, below the title on every screen; nothing while they ask for nothing."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from textual.content import Content
from textual.style import Style
from textual.widget import Widget

from text.i18n import _
from tui.agents.words import question_head, question_lines, standing_words
from tui.frame.actions.agents import allow_agent, allow_agent_for_a_time, refuse_agent

if TYPE_CHECKING:
    from collections.abc import Iterator

    from textual.timer import Timer

    from launcher.consent import Question
    from tui.actions import Action
    from tui.frame.host import Host

LOOK_S = 0.2


class AgentBanner(Widget):
    """Who asks, what would happen, and the keys; or who drives without asking."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {"agent-banner--head", "agent-banner--key"}
    DEFAULT_CSS = """
    AgentBanner {
        height: auto;
        width: 1fr;
        display: none;
        color: #000000;
        background: #ffb000;
        link-style: none;
        link-color: #000000;
        link-background: transparent;
        link-style-hover: reverse;
        .agent-banner--head { text-style: bold; }
        .agent-banner--key { text-style: bold reverse; }
    }
    """

    def __init__(self) -> None:
        super().__init__()
        self._lines: tuple[Content, ...] = ()
        self._question: Question | None = None
        self._host: Host | None = None
        self._timer: Timer | None = None
        """Notes regularly whether the question is in front: a dialog may cover it."""

    def show(self, host: Host) -> None:
        """Show the oldest question, or who drives without one."""
        self._host = host
        question = host.agents.question
        self._question = question
        lines = tuple(self._asked(host) if question is not None else self._standing(host))
        self.display = bool(lines)
        if question is not None and self._timer is None:
            self._timer = self.set_interval(LOOK_S, self._look)
        elif question is None and self._timer is not None:
            self._timer.stop()
            self._timer = None
        if lines != self._lines:
            self._lines = lines
            self.refresh(layout=True)
        self._look()

    @property
    def text(self) -> str:
        return self.render().plain

    def render(self) -> Content:
        """Draw a line for each sentence, cut at the edge; the keys are last and whole."""
        return Content("\n").join(self._lines)

    def _look(self) -> None:
        if self._host is not None and self.screen.is_current:
            self._host.agents.shown(self._question if self.display else None)

    def _asked(self, host: Host) -> Iterator[Content]:
        question = host.agents.question
        assert question is not None
        head = question_head(question, len(host.agents.state.questions) - 1)
        yield self._line(head, "agent-banner--head")
        for line in question_lines(question):
            yield self._line(line)
        yield self._keys(host, allow_agent, allow_agent_for_a_time, refuse_agent)

    def _standing(self, host: Host) -> Iterator[Content]:
        words = standing_words(host.agents.state)
        if words:
            yield self._line(words, "agent-banner--head")
        if words and host.agents.allowed:
            yield self._keys(host, refuse_agent)

    def _line(self, words: str, part: str = "") -> Content:
        style = self.get_visual_style(part) if part else ""
        line = Content.styled(f" {words}", style)
        return line.truncate(max(1, self.app.size.width), ellipsis=True)

    def _keys(self, host: Host, *actions: Action[Host]) -> Content:
        key = self.get_visual_style("agent-banner--key")
        parts = []
        for action in actions:
            click = Style.from_meta({"@click": f"app.act({action.id!r})"})
            title = _("End it") if len(actions) == 1 else _(action.title)
            parts += [
                Content(" "),
                Content.styled(f" {host.keys_of(action)[0]} ", key + click),
                Content.styled(f" {title} ", click),
            ]
        return Content("").join(parts)
