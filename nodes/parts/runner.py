"""Runs a node: it starts or says in one line why not, and ends properly when asked to.

Signals do not interrupt a node's code. They reach a thread through a pipe
(`signal.set_wakeup_fd`), which asks the loop to end after the current callback; the context is
still valid then, so a node that moves something can send a last stop. A callback that does not
return is not waited for.
"""

from __future__ import annotations

import faulthandler
import gc
import os
import signal
import sys
import threading
from collections.abc import Callable
from types import FrameType

import rclpy
from rclpy.exceptions import NameValidationException
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.logging import get_logger
from rclpy.signals import SignalHandlerOptions
from rclpy.utilities import remove_ros_args, try_shutdown

from nodes.parts.node import LessonNode, NodeUsageError, TranslatedLogger
from text.i18n import N_, detect

SIGNALS = (signal.SIGINT, signal.SIGTERM)
GRACE_S = 0.7
"""How long the current callback and `before_end` may take."""
DDS_GRACE_S = 3.0
"""How long the middleware may take to close a node."""
USAGE = 2
"""Exit code for invalid arguments and parameters."""
LONGEST = 80
"""Characters of an argument that an error repeats."""

_FAILED = "{problem}"
_NO_ARGUMENTS = N_("does not know {extra}: parameters are given as --ros-args -p name:=value (see --help)")
_NO_UTF_8 = N_("this argument is not UTF-8 text, which ROS takes: {word}")


def run(node_type: type[LessonNode], args: list[str] | None = None) -> int:
    """Run a node until SIGINT or SIGTERM; return the exit code.

    `args` are the arguments without the program's name, by default those of this process. From
    here on the process belongs to the node, signal handlers included.
    """
    arguments = sys.argv[1:] if args is None else list(args)
    if {"-h", "--help"} & set(arguments):
        sys.stdout.write(node_type.usage())
        return 0
    ending = Ending()
    try:
        return _live(node_type, arguments, ending)
    except NodeUsageError as error:
        logger = TranslatedLogger(get_logger(node_type.NAME), detect())
        logger.fatal(error.phrase, **error.values)
        return USAGE
    finally:
        try_shutdown()
        faulthandler.cancel_dump_traceback_later()
        ending.done()


def _live(node_type: type[LessonNode], arguments: list[str], ending: Ending) -> int:
    for word in arguments:
        # What is no UTF-8 has come as surrogates, which rcl cannot be given.
        if not word.isascii() and word.encode(errors="ignore").decode() != word:
            raise NodeUsageError(_NO_UTF_8, word=_shortened(word))
    try:
        rclpy.init(args=arguments, signal_handler_options=SignalHandlerOptions.NO)
    except RuntimeError as error:
        # rclpy's own error types are not public; the message ends with a place in C code.
        raise NodeUsageError(_FAILED, problem=str(error).split(", at /")[0]) from None
    extra = [word for word in remove_ros_args(arguments) if word]
    if extra:
        raise NodeUsageError(_NO_ARGUMENTS, extra=" ".join(extra))
    try:
        node = node_type()
    except NameValidationException as error:
        raise NodeUsageError(_FAILED, problem=" ".join(str(error).split())) from None
    # Existing objects stay: searching them for garbage would delay a callback.
    gc.freeze()
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    ending.wake_with(lambda: executor.create_task(_nothing))
    try:
        while not ending.asked:
            executor.spin_once()
        node.before_end()
    except ExternalShutdownException:
        pass
    _give_dds_time()
    executor.shutdown()
    node.destroy_node()  # type: ignore[no-untyped-call]
    return 0


def _shortened(word: str) -> str:
    """Return the begin of an argument, which may be a whole description of a robot."""
    return word if len(word) <= LONGEST else f"{word[: LONGEST - 1]}…"


def _give_dds_time() -> None:
    """End the process, with code 1, if closing the node takes longer than `DDS_GRACE_S`.

    Fast DDS 2.14 has been seen to spin for ever while closing a participant, in C with the
    interpreter lock held: then no Python thread can end the process, but faulthandler's can.
    """
    nowhere = os.open(os.devnull, os.O_WRONLY)
    faulthandler.dump_traceback_later(DDS_GRACE_S, exit=True, file=nowhere)


class Ending:
    """Turns the first SIGINT or SIGTERM into a request to end, and ensures that the node ends."""

    def __init__(self) -> None:
        self.asked = False
        """Whether a signal has come."""
        self._wake: Callable[[], object] = _nothing
        self._done = threading.Event()
        self._pipe, writer = os.pipe()
        os.set_blocking(writer, False)
        signal.set_wakeup_fd(writer, warn_on_full_buffer=False)
        for number in SIGNALS:
            signal.signal(number, _ignore)
        signal.pthread_sigmask(signal.SIG_UNBLOCK, SIGNALS)
        threading.Thread(target=self._watch, name="signals", daemon=True).start()

    def wake_with(self, wake: Callable[[], object]) -> None:
        """Call `wake`, from another thread, when the signal comes."""
        self._wake = wake

    def done(self) -> None:
        """Note that everything has been sent and closed."""
        self._done.set()

    def _watch(self) -> None:
        os.read(self._pipe, 1)
        self.asked = True
        self._wake()
        if not self._done.wait(GRACE_S):
            os._exit(0)


def _nothing() -> None:
    pass


def _ignore(_number: int, _frame: FrameType | None) -> None:
    """Do nothing, so that the signal only goes through the pipe."""
