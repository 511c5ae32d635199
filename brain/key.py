"""The key to a server: read when it is needed, and never shown.

It comes from the variable that the settings name, from a file that only its owner may read, or from
DECK_LLM_KEY. A server on this machine usually asks for none.
"""

from __future__ import annotations

import os
import re
import stat
from pathlib import Path
from typing import TYPE_CHECKING

from brain.faults import FaultKind, ModelError
from brain.settings import KEY_VARIABLE
from text.os_words import os_reason
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Mapping

    from brain.settings import ModelSettings

_LONGEST = 4096
_PRINTABLE = re.compile(r"[!-~]+")
_HIDDEN = "***"


class ServerKey:
    """A key that prints as `***`, whoever prints it."""

    __slots__ = ("_text",)

    def __init__(self, text: str = "") -> None:
        """An empty one stands for none."""
        self._text = text

    def reveal(self) -> str:
        """Return the key itself, for the header of a request and nothing else."""
        return self._text

    def hidden_in(self, text: str) -> str:
        """Return a text without the key: servers repeat it in what they complain of."""
        return text.replace(self._text, _HIDDEN) if self._text else text

    def __bool__(self) -> bool:
        return bool(self._text)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, ServerKey) and other._text == self._text

    def __hash__(self) -> int:
        return hash(self._text)

    def __repr__(self) -> str:
        return _HIDDEN if self._text else "-"


def key_of(settings: ModelSettings, environ: Mapping[str, str] | None = None) -> ServerKey:
    """Return the key that the settings name.

    Raises:
        ModelError: if there is none where they say, or others may read its file.
    """
    environ = os.environ if environ is None else environ
    if settings.key_env is not None:
        text = environ.get(settings.key_env, "")
        if not text:
            raise ModelError(
                FaultKind.SETTINGS,
                say("the variable {name} with the key is not set", name=settings.key_env),
                say("export {name}=... before deck", name=settings.key_env),
            )
        return _checked(text, settings.key_env)
    if settings.key_file is not None:
        path = Path(settings.key_file).expanduser()
        return _checked(_read(path), str(path))
    return _checked(environ[KEY_VARIABLE], KEY_VARIABLE) if environ.get(KEY_VARIABLE) else ServerKey()


def _read(path: Path) -> str:
    try:
        with path.open("rb") as file:
            mode = os.fstat(file.fileno()).st_mode
            if stat.S_IMODE(mode) & 0o077:
                raise ModelError(
                    FaultKind.SETTINGS,
                    say("others may read the key in {path}", path=str(path)),
                    say("chmod 600 {path}", path=str(path)),
                )
            return file.read(_LONGEST + 1).decode("utf-8", "replace")
    except OSError as error:
        words = say("no key in {path}: {reason}", path=str(path), reason=os_reason(error))
        raise ModelError(FaultKind.SETTINGS, words) from None


def _checked(text: str, place: str) -> ServerKey:
    """Refuse what no header can hold: an HTTP library would show it in its error."""
    text = text.strip()
    if len(text) > _LONGEST or not _PRINTABLE.fullmatch(text):
        words = say("{place} does not hold a key, which is one line of letters and digits", place=place)
        raise ModelError(FaultKind.SETTINGS, words)
    return ServerKey(text)
