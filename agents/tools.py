"""The tools: their names, what they are for, their arguments, and what carries them out."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from agents import acting, looking
from agents.arguments import (
    Arguments,
    CallArguments,
    EchoArguments,
    ExecuteArguments,
    FindArguments,
    HeadArguments,
    NoArguments,
    ProposeArguments,
    PublishArguments,
    SayArguments,
    SeeArguments,
)

if TYPE_CHECKING:
    from agents.driving import AgentDriving, Caller
    from agents.session import RobotSession
    from launcher.consent import AgentRules


@dataclass(frozen=True)
class ToolAnswer:
    """What a tool answers: facts, and perhaps a picture."""

    facts: dict[str, object]
    jpeg: str = ""
    """In base64; empty if there is none."""


@dataclass(frozen=True)
class Call:
    """One call of a tool."""

    session: RobotSession
    driving: AgentDriving
    caller: Caller
    arguments: Any
    """Of the tool's own class."""


Do = Callable[[Call], Awaitable[ToolAnswer]]


@dataclass(frozen=True)
class Tool:
    """A tool of an agent."""

    name: str
    about: str
    """For the model that chooses it."""
    arguments: type[Arguments]
    do: Do
    acts: bool = False
    """Whether it does more than look."""
    tells: bool = False
    """Whether it tells the log itself, before it acts."""
    waits: bool = True
    """Whether it waits until the graph is known, right after the start."""


async def _look(call: Call) -> ToolAnswer:
    rules = call.session.info.agents
    facts = await looking.look(call.session)
    limits = {"max_speed_m_s": rules.max_speed_m_s, "max_distance_m": rules.max_distance_m}
    return ToolAnswer({**facts, "approval": call.driving.approval.value, "limits": limits})


async def _see(call: Call) -> ToolAnswer:
    jpeg, facts = await looking.see(call.session, call.arguments)
    return ToolAnswer(facts, jpeg)


async def _topics(call: Call) -> ToolAnswer:
    return ToolAnswer(looking.topics(call.session, call.arguments))


async def _graph(call: Call) -> ToolAnswer:
    return ToolAnswer(looking.graph(call.session, call.arguments))


async def _echo(call: Call) -> ToolAnswer:
    return ToolAnswer(await looking.echo(call.session, call.arguments))


async def _propose(call: Call) -> ToolAnswer:
    asked: ProposeArguments = call.arguments
    return ToolAnswer(await call.driving.propose(call.session, call.caller, asked.commands, asked.reason))


async def _execute(call: Call) -> ToolAnswer:
    return ToolAnswer(await call.driving.execute(call.session, call.caller, call.arguments.proposal))


async def _head(call: Call) -> ToolAnswer:
    asked: HeadArguments = call.arguments
    return ToolAnswer(await call.driving.turn_head(call.session, call.caller, asked.pan, asked.tilt, asked.reason))


async def _stop(call: Call) -> ToolAnswer:
    call.driving.stopped()
    return ToolAnswer(await acting.stop(call.session))


async def _say(call: Call) -> ToolAnswer:
    return ToolAnswer(await acting.say_aloud(call.session, call.arguments.text))


async def _publish(call: Call) -> ToolAnswer:
    return ToolAnswer(await acting.publish(call.session, call.arguments))


async def _call(call: Call) -> ToolAnswer:
    return ToolAnswer(await acting.call(call.session, call.arguments))


TOOLS = (
    Tool(
        "look",
        "The state of the robot now: nodes, emergency stop, safety gate and why it holds, sonar "
        "distances in metres, pose, head, battery, and the limits for agents.",
        NoArguments,
        _look,
    ),
    Tool("see", "The newest picture of the robot's camera.", SeeArguments, _see),
    Tool("topics", "The ROS topics, with types and nodes.", FindArguments, _topics),
    Tool("graph", "The ROS nodes, with topics, services and actions.", FindArguments, _graph),
    Tool("echo", "The next messages of a ROS topic, as YAML.", EchoArguments, _echo),
    Tool(
        "propose",
        "Propose motion: nothing moves yet. Answers with an id for `execute`, what the safety "
        "gate would do now, and how far the robot would go. A drive ends by itself after the "
        "time that is answered.",
        ProposeArguments,
        _propose,
    ),
    Tool(
        "execute",
        "Carry out a proposal, once, within 60 s. The person at the robot's screen is asked, "
        "which takes up to 30 s; a refusal is final for this proposal: do not repeat it unasked.",
        ExecuteArguments,
        _execute,
        acts=True,
        tells=True,
    ),
    Tool(
        "stop",
        "Engage the emergency stop at once. Needs no consent. Only a person releases it.",
        NoArguments,
        _stop,
        acts=True,
        waits=False,
    ),
    Tool("say", "Have the robot say something aloud.", SayArguments, _say, acts=True),
    Tool(
        "head",
        "Turn the robot's head. The person at its screen is asked, as for `execute`.",
        HeadArguments,
        _head,
        acts=True,
        tells=True,
    ),
)
PUBLISH = Tool(
    "publish", "Publish one message on a topic that the robot's profile lists.", PublishArguments, _publish, acts=True
)
CALL = Tool("call", "Call a service that the robot's profile lists.", CallArguments, _call, acts=True)


def tools_for(rules: AgentRules | None) -> tuple[Tool, ...]:
    """Return the tools; direct publishing and calling only where a profile lists something."""
    raw = ()
    if rules is not None:
        raw = (*((PUBLISH,) if rules.publish else ()), *((CALL,) if rules.call else ()))
    return (*TOOLS, *raw)
