"""Transforms of the last seconds, for which one can wait."""

from __future__ import annotations

import sys
import threading
import time as wall
from typing import TYPE_CHECKING, Any

from rclpy.clock import Clock, JumpThreshold
from rclpy.duration import Duration
from rclpy.logging import get_logger
from rclpy.task import Future
from tf2_py import BufferCore

from tf2_ros.buffer_interface import BufferInterface

if TYPE_CHECKING:
    from collections.abc import Callable

    from rclpy.node import Node
    from rclpy.time import Time

LOOK_S = 0.02
UNHEARD_S = 2.0
"""So long nothing may fill a buffer that is asked before anything is in it."""
OURS = __file__.rpartition("/")[0]
NOW = Duration()


class Buffer(BufferCore, BufferInterface):
    """Keeps transforms of the last 10 s, or as long as it is asked to."""

    def __init__(self, cache_time: Duration | None = None, node: Node | None = None) -> None:
        BufferCore.__init__(self, cache_time)
        BufferInterface.__init__(self)
        self.is_filled = False
        """Whether a listener has the buffer, or somebody has put a transform into it; or it is told
        that neither is so."""
        self._made_s = wall.monotonic()
        self._waiting: list[Callable[[], None]] = []
        self._waiting_lock = threading.RLock()
        self.clock = node.get_clock() if node is not None else Clock()
        if node is not None:
            self._serve_frames(node)
        backwards = JumpThreshold(min_forward=None, min_backward=Duration(seconds=-1), on_clock_change=True)
        self.jump_handle = self.clock.create_jump_callback(backwards, post_callback=self._on_jump)

    def set_transform(self, transform: Any, authority: str) -> None:
        """Keep a transform of its time."""
        self.is_filled = True
        super().set_transform(transform, authority)
        self._tell()

    def set_transform_static(self, transform: Any, authority: str) -> None:
        """Keep a transform that holds at any time."""
        self.is_filled = True
        super().set_transform_static(transform, authority)
        self._tell()

    def lookup_transform(self, target_frame: str, source_frame: str, time: Time, timeout: Duration = NOW) -> Any:
        """Return where the source frame is in the target frame; time 0 asks for the newest."""
        self.can_transform(target_frame, source_frame, time, timeout)
        return self.lookup_transform_core(target_frame, source_frame, time)

    async def lookup_transform_async(self, target_frame: str, source_frame: str, time: Time) -> Any:
        """Return the same as soon as it is known."""
        await self.wait_for_transform_async(target_frame, source_frame, time)
        return self.lookup_transform_core(target_frame, source_frame, time)

    def lookup_transform_full(
        self,
        target_frame: str,
        target_time: Time,
        source_frame: str,
        source_time: Time,
        fixed_frame: str,
        timeout: Duration = NOW,
    ) -> Any:
        """Return where the source frame was then in the target frame as it is at its time."""
        way = (target_frame, target_time, source_frame, source_time, fixed_frame)
        self.can_transform_full(*way, timeout)
        return self.lookup_transform_full_core(*way)

    async def lookup_transform_full_async(
        self, target_frame: str, target_time: Time, source_frame: str, source_time: Time, fixed_frame: str
    ) -> Any:
        """Return the same as soon as it is known."""
        way = (target_frame, target_time, source_frame, source_time, fixed_frame)
        await self.wait_for_transform_full_async(*way)
        return self.lookup_transform_full_core(*way)

    def can_transform(
        self,
        target_frame: str,
        source_frame: str,
        time: Time,
        timeout: Duration = NOW,
        return_debug_tuple: bool = False,
    ) -> Any:
        """Return whether there is a transform, within a time; with the reason if asked."""
        found = self._wait(lambda: self.can_transform_core(target_frame, source_frame, time), timeout)
        return found if return_debug_tuple else found[0]

    def can_transform_full(
        self,
        target_frame: str,
        target_time: Time,
        source_frame: str,
        source_time: Time,
        fixed_frame: str,
        timeout: Duration = NOW,
        return_debug_tuple: bool = False,
    ) -> Any:
        """Return the same for a transform between two times."""
        way = (target_frame, target_time, source_frame, source_time, fixed_frame)
        found = self._wait(lambda: self.can_transform_full_core(*way), timeout)
        return found if return_debug_tuple else found[0]

    def wait_for_transform_async(self, target_frame: str, source_frame: str, time: Time) -> Future:
        """Return a future of the transform."""
        way = (target_frame, source_frame, time)
        return self._future(lambda: self.can_transform_core(*way)[0], lambda: self.lookup_transform_core(*way))

    def wait_for_transform_full_async(
        self, target_frame: str, target_time: Time, source_frame: str, source_time: Time, fixed_frame: str
    ) -> Future:
        """Return a future of a transform between two times."""
        way = (target_frame, target_time, source_frame, source_time, fixed_frame)
        return self._future(
            lambda: self.can_transform_full_core(*way)[0], lambda: self.lookup_transform_full_core(*way)
        )

    def _future(self, can: Callable[[], bool], find: Callable[[], Any]) -> Future:
        future = Future()

        def look() -> None:
            if future.done():
                return
            try:
                if can():
                    future.set_result(find())
            except Exception as error:  # noqa: BLE001 - it belongs to who waits
                future.set_exception(error)

        with self._waiting_lock:
            look()
            if not future.done():
                self._waiting.append(look)
                future.add_done_callback(lambda _: self._forget(look))
        return future

    def _forget(self, look: Callable[[], None]) -> None:
        with self._waiting_lock:
            if look in self._waiting:
                self._waiting.remove(look)

    def _tell(self) -> None:
        with self._waiting_lock:
            for look in tuple(self._waiting):
                look()

    def _on_jump(self, _jump: Any) -> None:
        get_logger("tf2_buffer").warning("Detected jump back in time. Clearing tf buffer.")
        self.clear()

    def _serve_frames(self, node: Node) -> None:
        try:
            from tf2_msgs.srv import FrameGraph
        except ImportError:
            # Deck's own tf2_msgs has only the message.
            return

        def answer(_request: Any, response: Any) -> Any:
            response.frame_yaml = self.all_frames_as_yaml()
            return response

        self.srv = node.create_service(FrameGraph, "tf2_frames", answer)

    def _wait(self, look: Callable[[], tuple[bool, str]], timeout: Duration) -> tuple[bool, str]:
        """Look until there is a transform or time is over; another thread has to receive it."""
        end = wall.monotonic() + timeout.nanoseconds / 1e9
        while not (found := look())[0] and wall.monotonic() < end:
            wall.sleep(LOOK_S)
        if not found[0] and not self.is_filled and wall.monotonic() - self._made_s >= UNHEARD_S:
            self._tell_unheard()
        return found

    def _tell_unheard(self) -> None:
        """Log, once, which line asks a buffer that nothing fills."""
        frame = sys._getframe()  # noqa: SLF001 - as the module warnings does
        while frame.f_code.co_filename.startswith(OURS) and frame.f_back is not None:
            frame = frame.f_back
        self.is_filled = True
        get_logger("tf2_buffer").warning(
            "nothing fills this buffer, a TransformListener would: asked in"
            f" {frame.f_code.co_filename}, line {frame.f_lineno}"
        )
