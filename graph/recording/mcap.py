"""The MCAP file of a recording: two timestamps per message, and a checksum per chunk.

The library's own writer stores the same time twice and no checksums: data that a bad disk has
changed would be played back as if they had been published.
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
"""Size of opcode and length, which the length does not include."""
CHECKSUM_AT = FRAME + 24
"""Offset of the checksum in a chunk's record, after its two times and its size."""
CHUNK_BYTES = 2**20


class McapFile(McapWriter):
    """An MCAP file in uncompressed chunks, named after its folder.

    A chunk ends with `close_chunk`, or by itself once it is larger than 1 MiB. `put` replaces
    the library's `write`: it takes the time of sending besides that of arrival. Chunk times,
    indexes and statistics follow the time of arrival.
    """

    def __init__(self, folder: Path) -> None:
        """Create the file in `folder`, where it must not exist yet. Raises OSError."""
        super().__init__(folder, CompressionMode.NONE)

    def put(self, connection: Connection, stamp_ns: int, sent_ns: int, raw: bytes) -> None:
        """Add a message that came at `stamp_ns` and was sent at `sent_ns`, unix time.

        A full chunk is written. Raises OSError.
        """
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
        """Write the chunk with its CRC-32. Raises OSError."""
        checksum = crc32(self.chunk.bio.getvalue())
        begin = self.bio.tell()
        super().close_chunk()
        end = self.bio.tell()
        self.bio.seek(begin + CHECKSUM_AT)
        self.bio.write(checksum.to_bytes(4, "little"))
        self.bio.seek(end)
