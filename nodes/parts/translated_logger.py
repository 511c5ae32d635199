"""The log messages of a node: English in the code, marked by `N_`; Russian in the catalogue.

One line per message, whatever its values.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from text.i18n import localized
from text.plain import plain
from text.sentences import say

if TYPE_CHECKING:
    from rclpy.impl.rcutils_logger import RcutilsLogger

LONGEST = 400
"""Maximum characters of a message; the rest is cut off."""


def printable(text: str) -> str:
    """Make it a single line without control characters, cut to length."""
    clean = plain(text)
    return clean if len(clean) <= LONGEST else clean[: LONGEST - 1] + "…"


class TranslatedLogger:
    """Logs phrases in one language."""

    def __init__(self, logger: RcutilsLogger, language: str) -> None:
        self._logger = logger
        self.language = language
        self._said_s: dict[str, float] = {}

    def text(self, phrase: str, **values: object) -> str:
        """Return the phrase in this language, printable."""
        return printable(localized(say(phrase, **values), self.language))

    # One line per severity: rclpy remembers the severity for each logging line of code.

    def info(self, phrase: str, *, every_s: float = 0.0, **values: object) -> None:
        """Log; not more often than every `every_s` seconds."""
        if self._is_due(phrase, every_s):
            self._logger.info(self.text(phrase, **values))

    def warn(self, phrase: str, *, every_s: float = 0.0, **values: object) -> bool:
        """Log a warning; not more often than every `every_s` seconds. Return whether it was."""
        if is_due := self._is_due(phrase, every_s):
            self._logger.warning(self.text(phrase, **values))
        return is_due

    def error(self, phrase: str, *, every_s: float = 0.0, **values: object) -> None:
        """Log an error; not more often than every `every_s` seconds."""
        if self._is_due(phrase, every_s):
            self._logger.error(self.text(phrase, **values))

    def fatal(self, phrase: str, **values: object) -> None:
        """Log why the node cannot go on."""
        self._logger.fatal(self.text(phrase, **values))

    def _is_due(self, phrase: str, every_s: float) -> bool:
        now_s = time.monotonic()
        if every_s and now_s - self._said_s.get(phrase, -every_s) < every_s:
            return False
        self._said_s[phrase] = now_s
        return True
