"""The outcome of a message to /llm_raw_json: the trail it left on the topics, with its delays."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from robot.joints import HEAD_PAN, HEAD_TILT
from robot.topics import DRIVE, DRIVE_SAFE, HEAD_STATE, LLM_RAW_JSON, LLM_RESULT, WHEEL_COMMANDS
from safety.topics import SAFETY_STATE
from text.i18n import _, ngettext
from text.plain import plain
from tui.emergency.state import blocked_reason
from tui.outcome import words

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from graph.data import Sample
    from robot.commands.schema import LlmResponse

SERVICE = "set_head_position"
FOLLOWED = frozenset({LLM_RESULT, DRIVE, DRIVE_SAFE, WHEEL_COMMANDS, HEAD_STATE, SAFETY_STATE})

ANSWER_WITHIN_S = 3.0
OVER_AFTER_S = 12.0
"""For how long the trail of a message is followed."""
SETTLED_S = 0.3
"""A steady topic that has not changed this long after the command already reflects it."""
NEAR_RAD = math.radians(1.5)
MOST_OF_A_KIND = 12


@dataclass(frozen=True)
class OutcomeEntry:
    """One event of the trail."""

    mark: str
    """`✓` done, `✗` refused, `!` held back, `→` passed on, `·` under way or awaited."""
    topic: str
    text: str
    delay_s: float | None = None
    """Delay after sending; None for an event that has not happened."""


class OutcomeTrail:
    """The trail of one message."""

    def __init__(
        self, sent_s: float, listeners: Sequence[str], expected: LlmResponse | None, before: Mapping[str, Sample]
    ) -> None:
        """`expected` is what was sent, if it was valid; `before` the newest samples until then."""
        self.sent_s = sent_s
        self.listeners = tuple(listeners)
        self.failure = ""
        """Why it could not be sent."""
        self._before = dict(before)
        commands = () if expected is None else expected.commands
        drives = sum(command.action == "drive" for command in commands)
        self._most_drives = MOST_OF_A_KIND if expected is None else drives
        turns = [command for command in commands if command.action == "turn_head"]
        self._target = (math.radians(turns[-1].pan), math.radians(turns[-1].tilt)) if turns else None
        self._came: dict[str, list[OutcomeEntry]] = {}
        """Entries by topic or service."""
        self._drive: tuple[float, float] | None = None
        self._drive_s: float | None = None
        """Delay of the newest setpoint after sending."""

    def over(self, now_s: float) -> bool:
        return bool(self.failure) or now_s - self.sent_s > OVER_AFTER_S

    def see(self, samples: Mapping[str, Iterable[Sample]]) -> None:
        # The effects of a setpoint can be recognised only after the setpoint itself.
        for topic, read in (
            (LLM_RESULT, self._see_result),
            (DRIVE, self._see_drive),
            (SAFETY_STATE, self._see_safety),
            (DRIVE_SAFE, self._see_drive_safe),
            (WHEEL_COMMANDS, self._see_wheels),
            (HEAD_STATE, self._see_head),
        ):
            for sample in samples.get(topic, ()):
                delay_s = sample.received_s - sample.age_s - self.sent_s
                if delay_s >= 0:
                    read(sample, delay_s)

    def entries(self, now_s: float) -> list[OutcomeEntry]:
        """All events so far in order of time, and what is still awaited."""
        came = [entry for entries in self._came.values() for entry in entries]
        came.sort(key=lambda entry: math.inf if entry.delay_s is None else entry.delay_s)
        return [*came, *self._awaited(now_s)]

    def _add(self, mark: str, topic: str, text: str, delay_s: float | None) -> None:
        entries = self._came.setdefault(topic, [])
        if len(entries) < MOST_OF_A_KIND:
            entries.append(OutcomeEntry(mark, topic, text, delay_s))

    def _awaited(self, now_s: float) -> Iterable[OutcomeEntry]:
        late = now_s - self.sent_s >= ANSWER_WITHIN_S
        if self.failure:
            yield OutcomeEntry("✗", LLM_RAW_JSON, _("not sent: {reason}").format(reason=plain(self.failure)))
        elif LLM_RESULT in self._came:
            return
        elif DRIVE in self._came:
            if late:
                yield OutcomeEntry("·", LLM_RESULT, _("no reply: this parser does not report"))
        elif not self.listeners:
            silence = _("nobody listens to {topic}: is llm_parser running?")
            yield OutcomeEntry("✗", LLM_RESULT, silence.format(topic=LLM_RAW_JSON))
        elif late:
            silence = _("no answer within {seconds} s: is llm_parser running? Listening: {nodes}")
            nodes = plain(", ".join(self.listeners))
            yield OutcomeEntry("✗", LLM_RESULT, silence.format(seconds=f"{ANSWER_WITHIN_S:g}", nodes=nodes))
        else:
            yield OutcomeEntry("·", LLM_RESULT, _("waiting for an answer"))

    def _see_result(self, sample: Sample, delay_s: float) -> None:
        event = words.event_of(sample.value)
        kind: Any = event.get("event")
        if kind == "accepted":
            count = words.number(event.get("commands"))
            whole = int(count) if math.isfinite(count) else 0
            commands = ngettext("{n} command", "{n} commands", whole).format(n=whole)
            thought = plain(str(event.get("thought", "")), words.LONGEST)
            text = _("accepted: {commands} “{thought}”").format(commands=commands, thought=thought)
            self._add("✓", LLM_RESULT, text, delay_s)
        elif kind == "refused":
            self._add("✗", LLM_RESULT, _("refused: nothing of it is executed"), delay_s)
            problems = event.get("problems")
            for problem in problems if isinstance(problems, list) else ():
                if isinstance(problem, dict):
                    self._add("✗", LLM_RESULT, words.reported_words(problem), delay_s)
        elif kind == "head":
            done, text = words.service_words(event)
            self._add("✓" if done else "✗", SERVICE, text, delay_s)

    def _see_drive(self, sample: Sample, delay_s: float) -> None:
        if len(self._came.get(DRIVE, ())) < self._most_drives:
            self._drive, self._drive_s = words.setpoint(sample.value), delay_s
            self._add("→", DRIVE, words.drive_words(*self._drive), delay_s)

    def _see_safety(self, sample: Sample, delay_s: float) -> None:
        reason = blocked_reason(sample)
        if reason and SAFETY_STATE not in self._came:
            self._add("!", SAFETY_STATE, plain(reason, words.LONGEST), delay_s)

    def _see_drive_safe(self, sample: Sample, delay_s: float) -> None:
        if self._drive is None or not self._is_news(DRIVE_SAFE, sample, delay_s):
            return
        passed = words.setpoint(sample.value)
        alike = all(math.isclose(a, b, abs_tol=1e-3) for a, b in zip(passed, self._drive, strict=True))
        if alike:
            self._add("✓", DRIVE_SAFE, _("let through"), delay_s)
        else:
            held = _("limited to {drive}").format(drive=words.drive_words(*passed))
            self._add("!", DRIVE_SAFE, held, delay_s)

    def _see_wheels(self, sample: Sample, delay_s: float) -> None:
        if self._is_news(WHEEL_COMMANDS, sample, delay_s):
            self._add("→", WHEEL_COMMANDS, words.wheel_words(sample.value), delay_s)

    def _is_news(self, topic: str, sample: Sample, delay_s: float) -> bool:
        """Whether this is the first message of the topic that reflects the setpoint."""
        if topic in self._came or self._drive_s is None or delay_s < self._drive_s:
            return False
        before = self._before.get(topic)
        if before is None or delay_s > self._drive_s + SETTLED_S:
            return True
        return _without_header(before) != _without_header(sample)

    def _see_head(self, sample: Sample, delay_s: float) -> None:
        had = self._came.get(HEAD_STATE, [])
        if self._target is None or (had and had[0].mark == "✓"):
            return
        looks = words.joint(sample.value, HEAD_PAN), words.joint(sample.value, HEAD_TILT)
        if any(map(math.isnan, looks)):
            # The position of servos that have not been moved is unknown.
            return
        there = all(abs(a - b) < NEAR_RAD for a, b in zip(looks, self._target, strict=True))
        entry = OutcomeEntry("✓" if there else "·", HEAD_STATE, words.head_words(*looks), delay_s if there else None)
        self._came[HEAD_STATE] = [entry]


def _without_header(sample: Sample) -> str:
    return repr([(key, value) for key, value in sample.value.items() if key != "header"])
