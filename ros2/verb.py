"""A verb announces itself: `@verb("topic list", "Output a list", *options)` on the function that does it.

The module of a command is found by its place, `ros2.verbs.topic`, and is imported only when it is called.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

if TYPE_CHECKING:
    import argparse
    from collections.abc import Callable

    Part: TypeAlias = Callable[[Any], object]
    """Declares options of a parser, or of a group in one."""
    Main: TypeAlias = Callable[[argparse.Namespace], int | str | None]
    """Returns the exit code, or an error text, which is the exit code 1."""


class Verb(NamedTuple):
    """What is announced."""

    summary: str
    parts: tuple[Part, ...]
    main: Main


VERBS: dict[str, Verb] = {}
"""Those of the commands that are imported, by command and verb: `topic list`, or `run` alone."""


def verb(name: str, summary: str, *parts: Part) -> Callable[[Main], Main]:
    """Announce a function as a verb; `parts`: its options, in the order of its help."""

    def announced(main: Main) -> Main:
        VERBS[name] = Verb(summary, parts, main)
        return main

    return announced


def arg(*names: str, **settings: Any) -> Part:  # noqa: ANN401 - as argparse has them
    """Return an option or argument, described as argparse has it."""
    return lambda parser: parser.add_argument(*names, **settings)


def flag(*names: str, help: str = "", **settings: Any) -> Part:  # noqa: A002, ANN401
    """Return an option without a value."""
    return arg(*names, action="store_true", help=help or None, **settings)


def either(*parts: Part) -> Part:
    """Return options of which one may be given."""

    def declare(parser: Any) -> None:  # noqa: ANN401 - a parser, or a group in one
        group = parser.add_mutually_exclusive_group()
        for part in parts:
            part(group)

    return declare


def every(*parts: Part) -> Part:
    """Return several options as one part."""

    def declare(parser: Any) -> None:  # noqa: ANN401 - a parser, or a group in one
        for part in parts:
            part(parser)

    return declare
