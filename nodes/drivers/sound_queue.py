"""Sound that waits for the loudspeaker: a queue of bytes that drops the oldest."""

from __future__ import annotations

import threading


class SoundQueue:
    """Holds at most `most` bytes; thread-safe."""

    def __init__(self, most: int) -> None:
        self._most = most
        self._sound = bytearray()
        self._lock = threading.Lock()

    def __len__(self) -> int:
        """Return the number of waiting bytes."""
        return len(self._sound)

    def put(self, sound: bytes) -> int:
        """Append sound; return how many bytes were dropped to make room."""
        with self._lock:
            self._sound += sound
            dropped = max(0, len(self._sound) - self._most)
            del self._sound[:dropped]
            return dropped

    def take(self, most: int) -> bytes:
        """Take at most this many bytes from the front."""
        with self._lock:
            sound = bytes(self._sound[:most])
            del self._sound[:most]
            return sound

    def clear(self) -> None:
        with self._lock:
            self._sound.clear()
