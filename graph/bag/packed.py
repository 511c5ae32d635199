"""What rosbag2 packs by zstd: whole files, or each message."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from graph.bag.kinds import ZSTD_MAGIC

if sys.version_info >= (3, 14):
    from compression import zstd
else:
    from backports import zstd

if TYPE_CHECKING:
    from pathlib import Path

_STEP = 65_536


def unpack(file: Path, target: Path) -> None:
    """Unpack a file, one that is cut short as far as it goes. Raises OSError and zstd's errors."""
    with zstd.open(file, "rb") as packed, target.open("wb") as plain:
        try:
            # Not `read`, which keeps nothing of what it has when it comes to the cut.
            while step := packed.read1(_STEP):
                plain.write(step)
        except (EOFError, zstd.ZstdError):
            if not plain.tell():
                raise


def unpacked(message: bytes) -> bytes | None:
    """Return a message as it was before it was packed; None if it is damaged.

    CDR begins with its encoding, 0 and 0 or 1, so that a packed message is never taken for a plain
    one, whatever metadata.yaml says.
    """
    if not message.startswith(ZSTD_MAGIC):
        return message
    try:
        return bytes(zstd.decompress(message))
    except zstd.ZstdError:
        return None
