"""The MCAP of a recording: two timestamps per message, and a checksum per chunk.

The library's own writer knows one time, and no checksums: what a bad disk has changed in a chunk
would be played as if it had been said.
"""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING
from zlib import crc32

from rosbags.rosbag2.enums import CompressionMode
from rosbags.rosbag2.storage_mcap import McapWriter

if TYPE_CHECKING:
    from pathlib import Path

    from rosbags.interfaces import Connection

MESSAGE = 0x05
HEAD = struct.Struct("<BQHIQQ")
"""Opcode, length, channel, sequence, log time, publish time."""
FRAME = 9
"""Opcode and length, which the length does not count."""
CHECKSUM_AT = FRAME + 24
"""Where a chunk has that of what is in it, after its two times and its size."""
CHUNK_BYTES = 2**20


class McapFile(McapWriter):
    """An `McapWriter` for messages that carry both the time of sending and that of arrival."""

    def __init__(self, folder: Path) -> None:
        """Make the file in `folder`. Raises OSError."""
        super().__init__(folder, CompressionMode.NONE)

    def put(self, connection: Connection, stamp_ns: int, sent_ns: int, raw: bytes) -> None:
        """Write a message that came at `stamp_ns` and was sent at `sent_ns`, unix time."""
        chunk = self.chunk
        self.message_start_time = min(stamp_ns, self.message_start_time)
        self.message_end_time = max(stamp_ns, self.message_end_time)
        self.channel_stats[connection.id] += 1
        chunk.message_start_time = min(stamp_ns, chunk.message_start_time)
        chunk.message_end_time = max(stamp_ns, chunk.message_end_time)
        chunk.msgs[connection.id].append((stamp_ns, chunk.bio.tell()))
        length = HEAD.size - FRAME + len(raw)
        chunk.bio.write(HEAD.pack(MESSAGE, length, connection.id, 0, stamp_ns, sent_ns))
        chunk.bio.write(raw)
        if chunk.bio.tell() > CHUNK_BYTES:
            self.close_chunk()

    def close_chunk(self) -> None:
        """Write the chunk, with its checksum. Raises OSError."""
        checksum = crc32(self.chunk.bio.getvalue())
        begin = self.bio.tell()
        super().close_chunk()
        end = self.bio.tell()
        self.bio.seek(begin + CHECKSUM_AT)
        self.bio.write(checksum.to_bytes(4, "little"))
        self.bio.seek(end)
