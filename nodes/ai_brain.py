"""The brain of lesson 9: hears a voice, checks the distance, and makes the robot act.

With `backend: rules` the reasoning is that of `robot.commands.brain`: with an obstacle within
`stop_distance`, or without a fresh and valid distance, the robot has to stop; otherwise the
head turns, the robot drives forward, and the loudspeaker announces it. A drive command ("стоп",
"left") is obeyed directly, unless it leads into the unknown.

With `backend: llm` the model of the user's settings is asked (`brain.settings`): it gets what
was heard, the distances, the pose, what the gate says, and what the camera sees. Its commands go to
/llm_raw_json, and so through llm_parser and the gate; it has no other way to the wheels. If there
are no settings, or nobody answers there, the rules decide, and the log says so; if an answer is
unusable, the robot stands. The word for stop never waits for a model.
"""

from __future__ import annotations

import math
import time
from typing import TYPE_CHECKING

from rclpy.serialization import deserialize_message
from sensor_msgs.msg import Image
from std_msgs.msg import ByteMultiArray, Float32, String

from brain.faults import FaultKind, ModelError
from nodes.parts.head_client import HeadAnswer, HeadClient
from nodes.parts.node import DEPTH, Choice, LessonNode, Number, SensorListener, Text
from nodes.parts.pictures import BadPictureError, jpeg_of
from nodes.parts.runner import run
from nodes.parts.sound import sound_message, sound_of
from nodes.parts.stop_news import StopNews
from robot.commands.brain import Decision, asks_to_stop, decide, spoken
from robot.commands.schema import DriveCommand, LlmResponse, SpokenResponse
from robot.safety.distance import Reading, range_state
from robot.sound import text_in
from robot.topics import AI_COMMAND, CAMERA, HEARD, LLM_RAW_JSON, MICROPHONE, SAY, SONAR_FRONT, SPEAKER
from robot.words import WORDS, addressed, parse_spoken, parse_word
from text.i18n import N_

if TYPE_CHECKING:
    from brain.situation import Situation
    from nodes.thinking.mind import ModelMind

LOOK_PAN_DEG, LOOK_TILT_DEG = 45, 0
FORWARD, STOP_WORD = WORDS["ru"][0], WORDS["ru"][4]
"""The course's own nodes know only Russian words."""

_STARTED = N_("The brain is awake and waits for a voice")
_HEARD = N_('Heard: "{words}"')
_NOT_FOR_ME = N_('Heard "{words}", which is not a command for me: say for example "robot, forward"')
_THINKING = N_("Thinking with the voice, {picture} and {distance}")
_PICTURE = N_("a picture")
_NO_PICTURE = N_("no picture")
_DISTANCE = N_("{metres:.2f} m ahead")
_NOTHING_NEAR = N_("nothing in range ahead")
_TOO_CLOSE = N_("something too close to measure ahead")
_NOT_VALID = N_("no valid distance straight ahead")
_NO_DISTANCE = N_("no distance")
_THOUGHTS = {
    Decision.LOOK_AND_GO: N_("The path is clear: I look round and drive on"),
    Decision.OBSTACLE: N_("An obstacle is near: I stop"),
    Decision.BLIND: N_("I do not know what is ahead: I stop"),
    Decision.OBEY: N_("As you say"),
}
_REPLIES = {
    Decision.LOOK_AND_GO: N_("I look round and drive on."),
    Decision.OBSTACLE: N_("There is something in front of me, I stand still."),
    Decision.BLIND: N_("I cannot see what is ahead, I stand still."),
    Decision.OBEY: N_("As you say."),
}
_DECIDED = N_("Decision: {thought}")
_NO_MODEL = N_("No model: {problem}; I follow my rules")
_NO_ANSWER = N_("No answer: {problem}; I stand")
_NO_ANSWER_ALOUD = N_("I cannot think just now, I stand still.")
_MODEL_THINKS = N_('The model thinks: "{thought}" ({count} commands)')
_NOBODY_LISTENS = N_("Nobody listens to {topic}: is llm_parser running?")
_BAD_PICTURE = N_("The picture is not sent: {problem}")
_BY_RULES = (FaultKind.SETTINGS, FaultKind.UNREACHABLE)
"""Without a model, or without a network, the brain is that of the course."""
_STANDS = LlmResponse(thought="no answer: stand", commands=[DriveCommand(action="drive", speed=0, steering=0)])
_HEAD_ASKED = N_("Asking the head for pan {pan}°, tilt {tilt}°")
_HEAD_DONE = N_("The head has turned")
_HEAD_REFUSED = N_("The head refused")
_HEAD_TROUBLE = N_("The head does not turn: {trouble}")


class AiBrain(LessonNode):
    """Turns each voice message into words, a decision and an answer."""

    NAME = "ai_brain"
    backend = Choice("rules", "Who thinks", fixed=True, choices=("rules", "llm"))
    prompt = Text("", "File with the system prompt; empty: Deck's own", may_be_empty=True)
    picture = Choice(
        "auto",
        "Whether the model gets the newest picture; auto: if vision_model is set",
        choices=("auto", "sent", "none"),
        fixed=True,
    )
    stop_distance = Number(1.0, "Nearer than this it stops", low=0.05, high=100.0, unit="m")
    stale_after_s = Number(2.5, "An older distance is ignored", low=0.1, high=60.0, unit="s")
    head_timeout = Number(5.0, "How long to wait for the head's answer", low=0.1, high=60.0, unit="s")

    def __init__(self) -> None:
        super().__init__()
        self._picture: bytes | None = None
        """Serialized: it is decoded only if a model asks for it."""
        self._front_m: float | None = None
        self._front_s = 0.0
        self._by_ear = False
        """Whether the newest words were recognised from sound, not sent as text."""
        self._command = self.create_publisher(String, AI_COMMAND, DEPTH)
        self._speaker = self.create_publisher(ByteMultiArray, SPEAKER, DEPTH)
        self._head = HeadClient(self, lambda: self.head_timeout)
        SensorListener(self, Image, CAMERA, self._see, depth=1, raw=True)
        SensorListener(self, Float32, SONAR_FRONT, self._measure)
        self._voice = self.create_publisher(String, SAY, DEPTH)
        self._mind = self._model_mind() if self.backend == "llm" else None
        StopNews(self, self._emergency)
        self.create_subscription(ByteMultiArray, MICROPHONE, self._hear, DEPTH)
        self.create_subscription(String, HEARD, self._understand, DEPTH)
        self.say.info(_STARTED)

    def before_end(self) -> None:
        if self._mind is not None:
            self._mind.close()

    def _model_mind(self) -> ModelMind | None:
        from nodes.thinking.mind import ModelMind
        from nodes.thinking.model import BrainState
        from nodes.thinking.senses import Senses

        try:
            mind = ModelMind(self, self._say_and_do, self._no_answer)
        except ModelError as error:
            self.say.warn(_NO_MODEL, problem=error.words)
            self._state = BrainState(self, None)
            return None
        self._senses = Senses(self, self.stale_after_s)
        self._json = self.create_publisher(String, LLM_RAW_JSON, DEPTH)
        return mind

    def _emergency(self) -> None:
        if self._mind is not None:
            self._mind.stop()

    def _see(self, picture: bytes) -> None:
        self._picture = picture

    def _measure(self, message: Float32) -> None:
        self._front_m, self._front_s = message.data, time.monotonic()

    def _hear(self, message: ByteMultiArray) -> None:
        sound = sound_of(message)
        # What a real microphone hears is recognised elsewhere.
        if text_in(sound) is not None:
            self._answer(spoken(sound))

    def _understand(self, message: String) -> None:
        words = parse_spoken(message.data)
        if words is None and self._mind is not None:
            words = addressed(message.data) or None
        if words is None:
            self.say.info(_NOT_FOR_ME, words=message.data)
            return
        self._answer(words, by_ear=True)

    def _answer(self, words: str, *, by_ear: bool = False) -> None:
        self._by_ear = by_ear
        self.say.info(_HEARD, words=words)
        self._tell_what_is_known()
        if self._mind is None:
            self._by_rules(words)
        elif asks_to_stop(words):
            self._mind.stop()
            self._act(Decision.OBEY, STOP_WORD)
        else:
            self._mind.think(self._senses.situation(words, self._fresh_front(), self._jpeg()))

    def _by_rules(self, words: str) -> None:
        reading = Reading(self._front_m, time.monotonic() - self._front_s)
        front = range_state(reading, self.stop_distance, self.stale_after_s)
        self._act(decide(parse_word(words), front), words)

    def _fresh_front(self) -> float | None:
        fresh = time.monotonic() - self._front_s <= self.stale_after_s
        return self._front_m if fresh else None

    def _jpeg(self) -> bytes:
        if self._picture is None or self._mind is None or not self._mind.sees:
            return b""
        try:
            return jpeg_of(deserialize_message(self._picture, Image))
        except BadPictureError as error:
            self.say.warn(_BAD_PICTURE, problem=self.say.text(error.phrase, **error.values))
            return b""

    # ---------------------------------------------------------------- what the model answers

    def _say_and_do(self, response: SpokenResponse) -> None:
        self._to_parser(response.silent())
        thought, count = response.thought, len(response.commands)
        self.say.info(_MODEL_THINKS, thought=thought, count=count)
        if response.say.strip():
            self._speak(response.say)

    def _no_answer(self, error: ModelError, situation: Situation) -> None:
        # What a recogniser understood may be anything: only a command is obeyed without a model.
        clear = not self._by_ear or parse_word(situation.heard) is not None
        if error.kind in _BY_RULES and clear:
            self.say.warn(_NO_MODEL, problem=error.words)
            self._by_rules(situation.heard)
            return
        self.say.error(_NO_ANSWER, problem=error.words)
        self._drive(STOP_WORD)
        self._speak(self.say.text(_NO_ANSWER_ALOUD))

    def _to_parser(self, response: LlmResponse) -> None:
        if not self._json.get_subscription_count():
            self.say.warn(_NOBODY_LISTENS, topic=LLM_RAW_JSON)
        self._json.publish(String(data=response.model_dump_json()))

    def _speak(self, words: str) -> None:
        self._speaker.publish(sound_message(words.encode()))
        self._voice.publish(String(data=words))

    # ---------------------------------------------------------------- what the rules decide

    def _tell_what_is_known(self) -> None:
        distance = self.say.text(_ahead(self._front_m), metres=self._front_m)
        picture = self.say.text(_NO_PICTURE if self._picture is None else _PICTURE)
        self.say.info(_THINKING, picture=picture, distance=distance)

    def _act(self, decision: Decision, words: str) -> None:
        self.say.info(_DECIDED, thought=self.say.text(_THOUGHTS[decision]))
        if decision == Decision.OBEY:
            self._drive(_canonical(words))
        elif decision == Decision.LOOK_AND_GO:
            self.say.info(_HEAD_ASKED, pan=LOOK_PAN_DEG, tilt=LOOK_TILT_DEG)
            self._head.turn(LOOK_PAN_DEG, LOOK_TILT_DEG, self._head_answered)
            self._drive(FORWARD)
        else:
            self._drive(STOP_WORD)
        self._speak(self.say.text(_REPLIES[decision]))

    def _drive(self, word: str) -> None:
        self._command.publish(String(data=word))
        if word == STOP_WORD and self._mind is not None:
            # The parser may still be repeating what the model said before.
            self._to_parser(_STANDS)

    def _head_answered(self, answer: HeadAnswer) -> None:
        if answer.trouble:
            self.say.warn(_HEAD_TROUBLE, trouble=answer.trouble)
        elif answer.sum:
            self.say.info(_HEAD_DONE)
        else:
            self.say.warn(_HEAD_REFUSED)


def _ahead(metres: float | None) -> str:
    if metres is None:
        return _NO_DISTANCE
    if math.isnan(metres):
        return _NOT_VALID
    if math.isinf(metres):
        return _NOTHING_NEAR if metres > 0 else _TOO_CLOSE
    return _DISTANCE


def _canonical(word: str) -> str:
    """Return the Russian word for the same motion."""
    asked = parse_word(word)
    return next((known for known in WORDS["ru"] if parse_word(known) == asked), STOP_WORD)


if __name__ == "__main__":
    raise SystemExit(run(AiBrain))
