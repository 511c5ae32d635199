"""The tools that act without moving the robot, and the stop, which needs nobody's consent."""

from __future__ import annotations

import asyncio
import contextlib
import re
import time
from typing import TYPE_CHECKING

from agents.refusal import refused
from agents.session import BOOL
from agents.tools import Call, Facts, Message, Request, RosName, Said, full_name, tool
from graph.messages.yaml_text import to_yaml
from graph.observer.requests import CallService, Publish
from launcher.errors import LauncherError
from robot.topics import (
    BRAIN_STATE,
    COMMAND_SOURCES,
    DRIVE_SAFE,
    HEAD_SERVICE,
    MOCK_MOTORS,
    MOCK_POSE,
    ODOMETRY,
    SONAR_FRONT,
    SONAR_REAR,
    SPEAKER,
    TF,
    TF_STATIC,
    VLM_DESCRIPTION,
    VLM_DETECTIONS,
)
from robot.words import parse_word
from safety.moving_topics import moves
from safety.topics import EMERGENCY_STATE, EMERGENCY_STOP, SAFETY_STATE
from text.plain import plain, plain_lines

if TYPE_CHECKING:
    from agents.view import GraphView

SOUND = "std_msgs/msg/ByteMultiArray"
SENT_WITHIN_S = 3.0
OBEYED_WITHIN_S = 2.0
CALLED_WITHIN_S = 10.0
MOST_CHARS = 8000
KEPT = frozenset(
    {
        *COMMAND_SOURCES,
        BRAIN_STATE,
        DRIVE_SAFE,
        EMERGENCY_STATE,
        EMERGENCY_STOP,
        MOCK_MOTORS,
        MOCK_POSE,
        ODOMETRY,
        SAFETY_STATE,
        SONAR_FRONT,
        SONAR_REAR,
        TF,
        TF_STATIC,
        VLM_DESCRIPTION,
        VLM_DETECTIONS,
    }
)
"""Topics that no profile opens to agents: motion, and what a decision about it rests on."""
KEPT_PACKAGES = frozenset({"rcl_interfaces", "lifecycle_msgs", "composition_interfaces"})
"""Packages of services that change the parameters or the life of a node."""
WORD = re.compile(r"[^\W\d_]+")


@tool(acts=True, waits=False)
async def stop(call: Call) -> Facts:
    """Engage the emergency stop at once. Needs no consent. Only a person releases it."""
    call.driving.stopped()
    session = call.session
    sending = session.observer.ask(Publish(EMERGENCY_STOP, BOOL, {"data": True}, latched=True))
    session.has_stopped = True
    view, emergency = session.view, session.emergency
    heard = _is_heard(view)
    if heard:
        # Beside it the road that needs no ROS; where no node listens it would be kept in vain.
        session.link.emergency_stop(True, time.time_ns())
    else:
        await session.settled()
        heard = _is_heard(view)
    ended: list[str] = []
    if not heard:
        ended = [node.name for node in session.link.nodes.values() if node.state.alive]
        await session.link.stop()
    with contextlib.suppress(LauncherError):  # The session may be ending.
        await session.link.withdraw()
    await asyncio.wait_for(asyncio.wrap_future(sending), SENT_WITHIN_S)
    await view.until(lambda: emergency.is_obeyed, OBEYED_WITHIN_S if heard else 0.0)
    return {
        "stopped": True,
        "held_by": emergency.holding,
        "nodes_ended": ended,
        "released_by": "a person at the screen, never an agent",
    }


def _is_heard(view: GraphView) -> bool:
    row = view.topic(EMERGENCY_STOP)
    return row is not None and row.subscribers > 0


@tool(acts=True)
async def say_aloud(call: Call, text: Said) -> Facts:
    """Have the robot say something aloud."""
    commands = [word for word in WORD.findall(text) if parse_word(word) is not None]
    if commands or parse_word(text) is not None:
        raise refused(
            "{word!r} is a word that drives the robot: its microphone would hear it",
            word=commands[0] if commands else text,
        )
    session = call.session
    row = session.view.topic(SPEAKER)
    if row is None or not row.subscribers:
        raise refused("nobody hears {topic}: the robot has no voice", topic=SPEAKER)
    sending = session.observer.ask(Publish(SPEAKER, SOUND, {"data": text.encode()}))
    await asyncio.wait_for(asyncio.wrap_future(sending), SENT_WITHIN_S)
    return {"said": text}


@tool(acts=True)
async def publish(call: Call, topic: RosName, message: Message) -> Facts:
    """Publish one message on a topic that the robot's profile lists."""
    session = call.session
    listed = session.info.agents.publish
    row = session.view.topic(topic)
    types = () if row is None else row.type_names
    for type_name in types or ("",):
        check_publish(topic, type_name, listed)
    if len(types) != 1:
        raise refused("the type of {topic} is not known: nobody uses it", topic=topic)
    sending = session.observer.ask(Publish(topic, types[0], message))
    try:
        count = await asyncio.wait_for(asyncio.wrap_future(sending), SENT_WITHIN_S + 2)
    except asyncio.TimeoutError:
        raise refused("it could not be sent in time") from None
    except Exception as error:  # of the message, by the agent
        raise refused("it cannot be published: {why}", why=plain(str(error), 300)) from error
    return {"topic": topic, "type": types[0], "subscribers": count}


@tool(acts=True)
async def call(call: Call, service: RosName, request: Request) -> Facts:
    """Call a service that the robot's profile lists."""
    session = call.session
    listed = session.info.agents.call
    row = next((one for one in session.view.services if one.name == service), None)
    types = () if row is None else row.type_names
    for type_name in types or ("",):
        check_call(service, type_name, listed)
    if len(types) != 1:
        raise refused("nobody serves {service}", service=service)
    calling = session.observer.ask(CallService(service, types[0], request, CALLED_WITHIN_S))
    result = await asyncio.wrap_future(calling)
    if not result.ok or result.response is None:
        raise refused("the call has failed: {why}", why=plain(result.error, 300))
    answer = plain_lines(to_yaml(result.response, 64))[:MOST_CHARS]
    return {"service": service, "answer": answer}


def check_publish(topic: str, type_name: str, listed: tuple[str, ...]) -> None:
    """Raise RefusedError for a topic or type that no agent may publish."""
    if topic not in map(full_name, listed):
        raise refused("the profile does not list {name} below `agents: publish:`", name=topic)
    if topic in KEPT or moves(topic, type_name):
        raise refused("{name} may move the robot, or its safety rests on it: use `propose`", name=topic)


def check_call(service: str, type_name: str, listed: tuple[str, ...]) -> None:
    """Raise a RefusedError if an agent may not call a service."""
    if service not in map(full_name, listed):
        raise refused("the profile does not list {name} below `agents: call:`", name=service)
    if service.rpartition("/")[2] == HEAD_SERVICE:
        raise refused("{name} moves the head: use `head`", name=service)
    if type_name.partition("/")[0] in KEPT_PACKAGES:
        raise refused("{name} changes how a node works: no agent may call it", name=service)
