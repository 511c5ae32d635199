"""Words to motion: takes `forward`, `налево`, `stop` and the like, and publishes /drive.

Each command is sent once, as in the course; with `repeat_for_s`, which a gate needs, it is sent ten
times a second for that long, followed by a stop. Any other word ends that, an unknown one with a
stop, and so does an emergency stop.
"""

from __future__ import annotations

from std_msgs.msg import String

from nodes.parts.node import DEPTH, LessonNode
from nodes.parts.repeat import REPEAT_FOR_S, DriveRepeater
from nodes.parts.runner import run
from robot.topics import AI_COMMAND
from robot.words import WORDS, parse_word
from text.i18n import N_

_STARTED = N_("Translating words into motion: {words}")
_DRIVE = N_('Heard "{word}": speed {speed:.2f} m/s, steering {steering:.2f} rad')
_UNKNOWN = N_('Unknown command "{word}", nothing is done. Known: {words}')


class AiDriver(LessonNode):
    """Commands a motion for each known word, and none for any other."""

    NAME = "ai_driver_translator"
    repeat_for_s = REPEAT_FOR_S

    def __init__(self) -> None:
        super().__init__()
        self._drive = DriveRepeater(self)
        self.create_subscription(String, AI_COMMAND, self._hear, DEPTH)
        self._known = ", ".join(WORDS[self.say.language])
        self.say.info(_STARTED, words=self._known)

    def before_end(self) -> None:
        """Leave no command behind that would still move the robot."""
        self._drive.end()

    def _hear(self, message: String) -> None:
        setpoint = parse_word(message.data)
        if setpoint is None:
            self._drive.hush()
            self.say.warn(_UNKNOWN, word=message.data[:80], words=self._known)
            return
        self._drive.say(setpoint)
        self.say.info(_DRIVE, word=message.data.strip(), speed=setpoint.speed_m_s, steering=setpoint.steering_rad)


if __name__ == "__main__":
    raise SystemExit(run(AiDriver))
