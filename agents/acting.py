"""The tools that act without moving the robot, and the stop, which needs nobody's consent."""

from __future__ import annotations

import asyncio
import contextlib
import re
import time
from typing import TYPE_CHECKING

from agents.raw_access import check_call, check_publish
from agents.refusal import refused
from agents.session import BOOL
from graph.messages.yaml_text import to_yaml
from graph.observer.requests import CallService, Publish
from launcher.errors import LauncherError
from robot.topics import EMERGENCY_STOP, SPEAKER
from robot.words import parse_word
from text.plain import plain, plain_lines

if TYPE_CHECKING:
    from agents.arguments import CallArguments, PublishArguments
    from agents.session import RobotSession
    from agents.view import GraphView

SOUND = "std_msgs/msg/ByteMultiArray"
SENT_WITHIN_S = 3.0
OBEYED_WITHIN_S = 2.0
CALLED_WITHIN_S = 10.0
MOST_CHARS = 8000
WORD = re.compile(r"[^\W\d_]+")


async def stop(session: RobotSession) -> dict[str, object]:
    """Engage the emergency stop; where no node obeys it, stop the nodes."""
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


async def say_aloud(session: RobotSession, text: str) -> dict[str, object]:
    """Have the robot say something that is no command: its own microphone hears it."""
    commands = [word for word in WORD.findall(text) if parse_word(word) is not None]
    if commands or parse_word(text) is not None:
        raise refused(
            "{word!r} is a word that drives the robot: its microphone would hear it",
            word=commands[0] if commands else text,
        )
    row = session.view.topic(SPEAKER)
    if row is None or not row.subscribers:
        raise refused("nobody hears {topic}: the robot has no voice", topic=SPEAKER)
    sending = session.observer.ask(Publish(SPEAKER, SOUND, {"data": text.encode()}))
    await asyncio.wait_for(asyncio.wrap_future(sending), SENT_WITHIN_S)
    return {"said": text}


async def publish(session: RobotSession, asked: PublishArguments) -> dict[str, object]:
    """Publish one message on a topic that the profile lists."""
    listed = session.info.agents.publish
    row = session.view.topic(asked.topic)
    types = () if row is None else row.type_names
    for type_name in types or ("",):
        check_publish(asked.topic, type_name, listed)
    if len(types) != 1:
        raise refused("the type of {topic} is not known: nobody uses it", topic=asked.topic)
    sending = session.observer.ask(Publish(asked.topic, types[0], asked.message))
    try:
        count = await asyncio.wait_for(asyncio.wrap_future(sending), SENT_WITHIN_S + 2)
    except asyncio.TimeoutError:
        raise refused("it could not be sent in time") from None
    except Exception as error:  # of the message, by the agent
        raise refused("it cannot be published: {why}", why=plain(str(error), 300)) from error
    return {"topic": asked.topic, "type": types[0], "subscribers": count}


async def call(session: RobotSession, asked: CallArguments) -> dict[str, object]:
    """Call a service that the profile lists."""
    listed = session.info.agents.call
    row = next((one for one in session.view.services if one.name == asked.service), None)
    types = () if row is None else row.type_names
    for type_name in types or ("",):
        check_call(asked.service, type_name, listed)
    if len(types) != 1:
        raise refused("nobody serves {service}", service=asked.service)
    calling = session.observer.ask(CallService(asked.service, types[0], asked.request, CALLED_WITHIN_S))
    result = await asyncio.wrap_future(calling)
    if not result.ok or result.response is None:
        raise refused("the call has failed: {why}", why=plain(result.error, 300))
    answer = plain_lines(to_yaml(result.response, 64))[:MOST_CHARS]
    return {"service": asked.service, "answer": answer}
