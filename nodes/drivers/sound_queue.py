"""Sound that waits for the loudspeaker: a queue of bytes that drops the oldest."""

from __future__ import annotations

import threading


class SoundQueue:
    """Holds so many bytes at most; to be used from several threads."""

    def __init__(self, most: int) -> None:
        self._most = most
        self._sound = bytearray()
        self._lock = threading.Lock()

    def __len__(self) -> int:
        """Bytes that wait."""
        return len(self._sound)

    def put(self, sound: bytes) -> int:
        """Add to the end; the bytes that were dropped for it come back as a number."""
        with self._lock:
            self._sound += sound
            dropped = max(0, len(self._sound) - self._most)
            del self._sound[:dropped]
            return dropped

    def take(self, most: int) -> bytes:
        """Take so many bytes at most from the beginning."""
        with self._lock:
            sound = bytes(self._sound[:most])
            del self._sound[:most]
            return sound

    def clear(self) -> None:
        """Forget everything."""
        with self._lock:
            self._sound.clear()
