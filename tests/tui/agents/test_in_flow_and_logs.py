"""What agents call: in Flow the beginning of what follows, in Logs a line in the language."""

from __future__ import annotations

from launcher.events import LogEvent
from launcher.status import LogLine, Severity
from tests.tui.app_runs import opened
from tests.tui.recorded import NOW_S, RecordedOpener
from tests.waiting import until
from text.sentences import say
from tui.flow.screen import FlowScreen

DOES = say("agent “{agent}” does {id}: {words}", agent="claude", id="p1", words="drives")
LOOKS = say(
    "agent “{agent}”: {tool} {arguments}: {outcome}",
    agent="claude",
    tool="look",
    arguments="{}",
    outcome=say("done"),
)


def said_by_agents() -> LogEvent:
    """Lines of the supervisor about agents."""
    return LogEvent(
        (
            LogLine("agent", 1, NOW_S, Severity.DEBUG, LOOKS, "", "agent"),
            LogLine("agent", 2, NOW_S + 0.1, Severity.WARN, DOES, "", "agent"),
        )
    )


async def test_what_an_agent_does_begins_a_chain() -> None:
    opener = RecordedOpener()
    async with opened(opener, "flow") as (app, _pilot):
        screen = app.screen
        assert isinstance(screen, FlowScreen)
        opener.link.say(said_by_agents())
        chains = await until(
            lambda: [one for one in screen.chains if one.first.lane.value == "agent"], "a chain"
        )
        assert [one.first.text for one in chains] == ["agent “claude” does p1: drives"]
