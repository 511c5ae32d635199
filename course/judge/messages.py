"""Checks of the messages that come: how often, what is in them, or that there are none."""

from __future__ import annotations

import math
import re
import time
from typing import TYPE_CHECKING, Any

from course.judge.evidence import MET, Observation
from course.judge.fields import FieldMissingError, differs, field_at, shown
from course.judge.missing import no_messages, wrong_type
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Sequence

    from course.judge.evidence import Evidence, ReceivedMessage
    from launcher.profile.steps.checks import FieldCheck, ImageCheck, NothingCheck, RateCheck

IMAGE = "sensor_msgs/msg/Image"
FEW = 3
"""Messages that show whether something changes."""


def rate(check: RateCheck, evidence: Evidence, since_s: float) -> Observation | None:
    """Messages arrive so many times a second."""
    return _rate(check.rate, check.between, check.over, "", evidence, max(since_s, evidence.fresh_s(check.rate)))


def _rate(
    topic: str, between: tuple[float, float], over_s: float, type_name: str, evidence: Evidence, since_s: float
) -> Observation | None:
    now_s = time.time()
    messages = evidence.messages(topic, max(since_s, now_s - over_s))
    if not messages:
        return no_messages(evidence, topic, type_name)
    first_s = evidence.messages(topic, since_s)[0].time_s
    hz = _hz(messages, now_s - max(since_s, now_s - over_s))
    low, high = between
    if now_s - first_s < over_s and not (now_s - since_s > 2 * over_s):
        return None
    if low <= hz <= high:
        return MET
    return Observation(
        met=False,
        seen=say("{topic} comes {hz} times a second", topic=topic, hz=_about(hz, between)),
        look=say("Look at the period of the timer: it is in seconds, 1 / rate."),
    )


def _about(hz: float, between: tuple[float, float]) -> str:
    """Return a rate so coarsely that it is the same in each run, but not as one that is right."""
    if not 0 < hz < math.inf:
        return f"{hz:g}"
    step = 10 ** math.floor(math.log10(hz)) / 2
    about = round(hz / step) * step
    return f"{hz:.2f}" if between[0] <= about <= between[1] else f"{about:g}"


def _hz(messages: Sequence[ReceivedMessage], window_s: float) -> float:
    if len(messages) < 2:
        return len(messages) / window_s
    span_s = messages[-1].time_s - messages[0].time_s
    return (len(messages) - 1) / span_s if span_s > 0 else float("inf")


def field(check: FieldCheck, evidence: Evidence, since_s: float) -> Observation:
    """A field of the newest messages has a value.

    After a message was published, any that complies will do: others may come beside it.
    """
    messages = evidence.messages(check.field, since_s or evidence.fresh_s(check.field))
    count = max(check.messages, FEW) if check.changes else check.messages
    if len(messages) < count:
        return no_messages(evidence, check.field, check.type)
    if messages[-1].type_name != check.type:
        return wrong_type(check.field, check.type, (messages[-1].type_name,))
    if not since_s or check.messages > 1:
        messages = messages[-count:]
    try:
        found = [field_at(message.value, check.path) for message in messages]
    except FieldMissingError as error:
        return Observation(met=False, seen=error.words)
    if check.changes is not None:
        return _changes(check, found)
    wrong = [value for value in found if not _complies(check, value)]
    if not wrong or (since_s and check.messages == 1 and len(wrong) < len(found)):
        return MET
    return Observation(met=False, seen=_is(check.path, check.field, wrong[-1]))


def _is(path: str, topic: str, value: Any) -> str:  # noqa: ANN401 - any field
    return say("{path} of {topic} is {value}", path=path, topic=topic, value=shown(value))


def _complies(check: FieldCheck, value: Any) -> bool:  # noqa: ANN401 - any field
    if check.between is not None:
        low, high = check.between
        return isinstance(value, (int, float)) and low <= value <= high
    if check.matches is not None:
        return re.search(check.matches, shown(value)) is not None
    return not differs(check.equals, value, check.tolerance)


def _changes(check: FieldCheck, found: list[Any]) -> Observation:
    changes = any(differs(found[0], value, None) for value in found[1:])
    if changes == check.changes:
        return MET
    path, topic = check.path, check.field
    if check.changes:
        seen = say("{path} of {topic} is always {value}", path=path, topic=topic, value=shown(found[0]))
    else:
        seen = say("{path} of {topic} changes", path=path, topic=topic)
    return Observation(met=False, seen=seen)


def image(check: ImageCheck, evidence: Evidence, since_s: float) -> Observation | None:
    """Images come, of a size and an encoding."""
    since_s = since_s or evidence.fresh_s(check.image)
    messages = evidence.messages(check.image, since_s)
    if not messages:
        return no_messages(evidence, check.image, IMAGE)
    if messages[-1].type_name != IMAGE:
        return wrong_type(check.image, IMAGE, (messages[-1].type_name,))
    if check.changes and len(messages) < FEW:
        return None
    complaint = (
        _wrong_format(check, messages[-1]) or _size_complaint(messages[-1]) or _always_the_same(check, messages)
    )
    if complaint:
        return Observation(met=False, seen=complaint)
    if check.rate is None:
        return MET
    return _rate(check.image, check.rate, 2.0, IMAGE, evidence, since_s)


def _wrong_format(check: ImageCheck, message: ReceivedMessage) -> str:
    for name in ("width", "height", "encoding"):
        wanted, found = getattr(check, name), message.value[name]
        if wanted is not None and found != wanted:
            return _is(name, check.image, found)
    return ""


def _always_the_same(check: ImageCheck, messages: Sequence[ReceivedMessage]) -> str:
    pictures = {bytes(message.value["data"]) for message in messages[-FEW:]}  # type: ignore[arg-type]
    if not check.changes or len(pictures) > 1:
        return ""
    return say("all pictures of {topic} are the same", topic=check.image)


def _size_complaint(message: ReceivedMessage) -> str:
    step, height = int(str(message.value["step"])), int(str(message.value["height"]))
    held = len(message.value["data"])  # type: ignore[arg-type]
    if held == step * height:
        return ""
    return say("data holds {held} bytes, and step times height are {wanted}", held=held, wanted=step * height)


def nothing(check: NothingCheck, evidence: Evidence, since_s: float) -> Observation | None:
    """No message comes for some time; None while that time is not over."""
    messages = evidence.messages(check.nothing, since_s)
    if messages:
        return Observation(met=False, final=True, seen=say("a message came on {topic}", topic=check.nothing))
    return MET if time.time() - since_s >= check.for_s else None
