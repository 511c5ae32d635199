"""Expressions that make of a value what a field of a message takes.

Each is tried on a message of the same class before it is suggested: a suggestion fixes the line.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    Way = tuple[str, Callable[[], Any]]

_MOST = 1 << 20
"""Values of a list that are converted for a trial."""


def takes(kind: Any, field: str, value: Any) -> bool:  # noqa: ANN401 - a class of messages
    """Whether a field of a message takes a value, as its own setter says."""
    message = kind()
    message._check_fields = True  # noqa: SLF001 - Jazzy's; others check always
    try:
        setattr(message, field, value)
    except Exception:  # noqa: BLE001 - an array of numpy raises what it likes when it is asked
        return False
    return True


def first_fitting(kind: Any, field: str, ways: Iterator[Way]) -> str:  # noqa: ANN401
    """Return the first expression whose value the field takes, empty if there is none."""
    for expression, value in ways:
        try:
            made = value()
        except Exception:  # noqa: BLE001 - what cannot be converted this way
            continue
        if takes(kind, field, made):
            return expression
    return ""


def single(what: str, value: Any) -> Iterator[Way]:  # noqa: ANN401
    """Yield what makes one number or text of a value: a literal, or a call."""
    if re.fullmatch(r"-?\d+", what):
        yield f"{what}.0", lambda: float(value)
    yield f"float({what})", lambda: float(value)
    yield f"int({what})", lambda: int(value)
    if isinstance(value, str):
        yield f"int(float({what}))", lambda: int(float(value))


def constant_of(kind: Any, field: str, value: Any) -> str:  # noqa: ANN401 - a class of messages
    """Return the constant of a message that a text names: `Range.ULTRASOUND`."""
    if not isinstance(value, str):
        return ""
    name = value.strip().upper().replace(" ", "_")
    known = {each: getattr(kind, each) for each in dir(type(kind)) if each.isupper()}
    fits = [
        each
        for each in known
        if not each.startswith("_")
        and (each == name or each.endswith(f"_{name}"))
        and takes(kind, field, known[each])
    ]
    return f"{kind.__name__}.{fits[0]}" if len(fits) == 1 else ""


def listing(what: str, value: Any, count: int = 1) -> Iterator[Way]:  # noqa: ANN401
    """Yield what makes a list of `count` values of one value, a text, or a dictionary."""
    if isinstance(value, str):
        yield f'{what}.split(",")', lambda: value.split(",") if "," in value else None
        yield (
            f'[float(v) for v in {what}.split(",")]',
            lambda: [float(v) for v in value.split(",")] if "," in value else None,
        )
        yield (
            f'[int(v) for v in {what}.split(",")]',
            lambda: [int(v) for v in value.split(",")] if "," in value else None,
        )
        yield f"list({what}.encode())", lambda: list(value.encode())
    times = f" * {count}" if count > 1 else ""
    yield f"[{what}]{times}", lambda: [value] * count
    for expression, made in single(what, value):
        yield f"[{expression}]{times}", lambda made=made: [made()] * count  # type: ignore[misc]
    if isinstance(value, dict):
        yield f"list({what}.values())", lambda: list(value.values())


def of_array(what: str, value: Any, of: str) -> Iterator[Way]:  # noqa: ANN401 - of numpy
    """Yield what makes a flat list, or bytes, of an array of numpy; `of`: the field's type."""
    if value.size > _MOST:
        value = value[:1]
    if of == "uint8":
        if str(value.dtype) == "uint8":
            yield f"{what}.tobytes()", value.tobytes
        yield f"{what}.astype(np.uint8).tobytes()", lambda: _whole(value, "uint8").tobytes()
    flat = "" if value.ndim == 1 else ".flatten()"
    yield f"{what}{flat}.tolist()", lambda: value.flatten().tolist()
    for name in ("float", "int", "str", "bool"):
        kind = {"float": float, "int": int, "str": str, "bool": bool}[name]
        yield (
            f"{what}{flat}.astype({name}).tolist()",
            lambda kind=kind: value.flatten().astype(kind).tolist(),  # type: ignore[misc]
        )


def _whole(value: Any, name: str) -> Any:  # noqa: ANN401 - of numpy
    """Convert an array of numbers, whose values a byte holds."""
    if not ((value >= 0) & (value < 256)).all():
        raise ValueError(name)
    return value.astype(name)


def each_of(values: list[Any]) -> Iterator[Way]:
    """Yield what converts each of the values of a list."""
    yield "[float(v) for v in …]", lambda: [float(each) for each in values]
    yield "[int(v) for v in …]", lambda: [int(each) for each in values]
    yield "[str(v) for v in …]", lambda: [str(each) for each in values]
    yield "[v for row in … for v in row]", lambda: [each for row in values for each in row]
    yield ("[float(v) for row in … for v in row]", lambda: [float(each) for row in values for each in row])
