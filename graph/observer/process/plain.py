"""Plain data as bytes and back: what goes between the screen and the observer's process.

The bytes are a pickle, which Python writes and reads in C, but of a kind that cannot name anything
beyond the plain types listed here: a pickle that names something else is refused before anything of
it is made. Large byte strings, pictures for one, are passed on as they are and not copied.
"""

from __future__ import annotations

import io
import pickle
import sys
from dataclasses import is_dataclass
from enum import Enum
from functools import lru_cache
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    import numpy as np
    from numpy.typing import NDArray

    from graph.messages.making import FieldError

PROTOCOL = 5
NUMBERS = "biufc?"
"""Kinds of numpy arrays that are numbers."""


class PlainError(Exception):
    """Something is not plain data, or not bytes that `packed` has made."""


def packed(value: object) -> list[bytes]:
    """Return a value as pieces of bytes. Raises PlainError."""
    file = _Pieces()
    try:
        pickler = pickle.Pickler(file, PROTOCOL)
        if "graph.data" in sys.modules:
            pickler.dispatch_table = _table("numpy" in sys.modules)
        pickler.dump(value)
    except Exception as error:
        raise PlainError(f"not plain data: {error}") from error
    return file.pieces


def unpacked(raw: bytes | bytearray) -> Any:  # noqa: ANN401 - whatever was packed
    """Return the value. Raises PlainError for bytes that `packed` has not made."""
    try:
        return _Unpickler(io.BytesIO(raw)).load()
    except Exception as error:
        raise PlainError(f"not plain data: {error}") from error


class _Pieces:
    """A file that keeps what is written to it, each piece as it is."""

    def __init__(self) -> None:
        self.pieces: list[bytes] = []

    def write(self, piece: bytes) -> None:
        self.pieces.append(bytes(piece))


class _Unpickler(pickle.Unpickler):
    """Knows the plain types by their names, and nothing else."""

    def find_class(self, module: str, name: str) -> Any:  # noqa: ANN401
        return _known()[module, name]


@lru_cache(maxsize=1)
def _known() -> dict[tuple[str, str], Any]:
    """Return all that a pickle may name. A process that is started ahead needs none of it yet."""
    from graph.messages.making import FieldError, NoSuchFieldError
    from graph.messages.types import UnknownTypeError
    from graph.observer.census import Census
    from graph.publishing.dead_man_switch import HeldCommand
    from space.buffer import Stamped
    from space.transform import Transform
    from text.sentences import InLanguages, Words

    plain = [each for each in _classes() if is_dataclass(each) or issubclass(each, Enum)]
    errors = (*_by_words(), FieldError, NoSuchFieldError, UnknownTypeError)
    others = (Census, HeldCommand, Stamped, Transform, Words, InLanguages)
    makers = (array_of, field_error)
    every: tuple[Any, ...] = (*plain, *others, *errors, *makers)
    return {(each.__module__, each.__qualname__): each for each in every}


def _classes() -> list[type]:
    """Return the classes of the rooms whose data go over."""
    from graph import data, inner_states

    rooms = (data, inner_states)
    return [each for room in rooms for each in vars(room).values() if isinstance(each, type)]


@lru_cache(maxsize=2)
def _table(has_numpy: bool) -> dict[type, Callable[[Any], tuple[Any, ...]]]:
    """Return how to take apart what Python does not take apart by itself, or not plainly."""
    from graph.messages.making import FieldError, NoSuchFieldError
    from graph.messages.types import UnknownTypeError
    from text.sentences import Words

    kinds = [each for each in _classes() if issubclass(each, Enum)]
    table: dict[type, Callable[[Any], tuple[Any, ...]]] = {
        # Python 3.11.0 to 3.11.3 would have `getattr` called.
        **dict.fromkeys(kinds, lambda member: (type(member), (member.value,))),
        **dict.fromkeys(_by_words(), lambda error: (type(error), (error.words,))),
        **dict.fromkeys((FieldError, NoSuchFieldError), _of_field_error),
        # Its values may be whatever can be written down: an error, for one.
        Words: lambda words: (Words, (words.template, _plain_values(words.values))),
        UnknownTypeError: lambda error: (
            UnknownTypeError,
            (error.type_name, error.package, error.reason, dict(error.install)),
        ),
    }
    if has_numpy:
        import numpy as np

        table[np.ndarray] = lambda array: (array_of, (array.dtype.str, array.tobytes()))
    return table


def _plain_values(values: Mapping[str, object]) -> dict[str, object]:
    return {name: value if isinstance(value, (str, int, float)) else str(value) for name, value in values.items()}


@lru_cache(maxsize=1)
def _by_words() -> tuple[type[Exception], ...]:
    """Return the errors that are made of their words alone."""
    from graph.calls.goals import GoalError
    from graph.observer.requests import ObserverError
    from graph.publishing.outbox import PublishError

    return ObserverError, PublishError, GoalError


def _of_field_error(error: FieldError) -> tuple[Any, ...]:
    from graph.messages.making import NoSuchFieldError

    missing = isinstance(error, NoSuchFieldError)
    return field_error, (missing, error.field, error.message, error.line, error.column)


def field_error(missing: bool, field: str, message: str, line: int | None, column: int | None) -> FieldError:
    """Put an error about a field together again."""
    from graph.messages.making import FieldError, NoSuchFieldError

    made = (NoSuchFieldError if missing else FieldError)(field, message)
    made.line, made.column = line, column
    return made


def array_of(kind: str, raw: bytes) -> NDArray[np.generic]:
    """Return the one-dimensional array of numbers of this numpy type, read-only."""
    import numpy as np

    dtype = np.dtype(kind)
    if dtype.kind not in NUMBERS:
        raise PlainError(f"an array of {kind}")
    return np.frombuffer(raw, dtype)


def plain_error(error: BaseException) -> Exception:
    """Return an error as it may be handed to another process: itself, or its words."""
    from graph.messages.making import FieldError
    from graph.messages.types import UnknownTypeError
    from graph.observer.requests import ObserverError
    from text.sentences import reason_of

    plain = (*_by_words(), FieldError, UnknownTypeError)
    if isinstance(error, Exception) and isinstance(error, plain):
        return error
    return ObserverError(reason_of(error))
