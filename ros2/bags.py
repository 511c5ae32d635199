"""What the verbs of `ros2 bag` have in common: the options that are refused, and where ROS is."""

from __future__ import annotations

import argparse
import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from graph.ros import PEERS, RANGE

if TYPE_CHECKING:
    from collections.abc import Callable

    from graph.bag.reading import Bag

STORAGES = ("mcap", "sqlite3")
LONGEST = 600
"""Of what is said of a bag, in characters."""


class _Refused(argparse.Action):
    """An option of the real tool that is not here: better an error than another recording."""

    def __call__(
        self,
        parser: argparse.ArgumentParser,
        _namespace: argparse.Namespace,
        _values: str | Sequence[Any] | None,
        option_string: str | None = None,
    ) -> None:
        parser.error(f"{option_string} is not in Deck's ros2")


def refuse(parser: argparse.ArgumentParser, *options: str) -> None:
    """Declare options of the real tool that are not here."""
    for option in options:
        parser.add_argument(*option.split(), action=_Refused, nargs="*", help=argparse.SUPPRESS)


def ignore(parser: argparse.ArgumentParser, *options: str) -> None:
    """Declare options of the real tool, with a value, that change nothing here."""
    for option in options:
        parser.add_argument(*option.split(), help=argparse.SUPPRESS)


def existing(text: str) -> Path:
    """Read the path of a bag."""
    if not os.path.exists(text):  # noqa: PTH110 - a name with a NUL is no error
        raise argparse.ArgumentTypeError(f"Bag path '{text}' does not exist!")
    return Path(text)


def bag_path(parser: argparse.ArgumentParser, doing: str) -> None:
    """Declare which bag to open."""
    parser.add_argument("bag_path", type=existing, help=f"Bag to {doing}")
    parser.add_argument(
        "-s",
        "--storage",
        choices=STORAGES,
        help="Storage implementation of bag. By default attempts to detect automatically",
    )


def place() -> tuple[int, str | tuple[str, ...]]:
    """Return the domain and the discovery that the environment asks for."""
    domain = os.environ.get("ROS_DOMAIN_ID") or "0"
    if not domain.isdecimal():
        raise RuntimeError(f"ROS_DOMAIN_ID is not an integral number: {domain}")
    peers = tuple(filter(None, os.environ.get(PEERS, "").split(";")))
    if peers:
        return int(domain), peers
    near = os.environ.get(RANGE, "").upper() == "LOCALHOST"
    return int(domain), "localhost" if near else "subnet"


def tell(bag: Bag, warn: Callable[[str], None]) -> None:
    """Warn of what is missing in a bag, or differs from what it says of itself."""
    from text.i18n import localized
    from text.plain import plain

    for words in bag.notes:
        warn(plain(localized(words), LONGEST))


def verdict(bag: Bag, warn: Callable[[str], None]) -> int | None:
    """Warn of damage that was met; return the exit code, 1 for a bag that lacks messages."""
    from text.i18n import localized
    from text.plain import plain

    damage = bag.damage
    if damage is not None:
        warn(plain(localized(damage), LONGEST))
    return 1 if damage is not None or bag.is_incomplete else None
