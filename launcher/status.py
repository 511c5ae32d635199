"""The data that the supervisor sends its clients: plain, and the same at both ends of the socket.

Every duration is in seconds on the monotonic clock, every memory figure in bytes,
every CPU figure in percent of one core.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass, field
from enum import Enum
from typing import Any

from launcher.consent import DEFAULT_RULES, AgentRules
from launcher.wire import Sentence
from text.packing import pack_text, unpack_text
from text.sentences import Words, say

NOT_READY = "not ready"
"""The start of the supervisor's message about a node that was not ready in time."""


class NodeState(str, Enum):
    """The state of a node in its life cycle."""

    WAITING = "waiting"
    """Not yet started: a node that it needs is not ready."""
    STARTING = "starting"
    """Its process runs, but its readiness condition does not hold yet."""
    READY = "ready"
    """Its readiness condition holds."""
    RUNNING = "running"
    """Its process runs and it has no readiness condition to check."""
    STOPPING = "stopping"
    EXITED = "exited"
    """Ended: by itself with exit code 0 and nothing left to do, or stopped by the user."""
    BACKOFF = "backoff"
    """Ended and will be started again; `NodeStatus.detail` says when."""
    FAILED = "failed"
    """Ended and will not be started again; `NodeStatus.detail` says why."""

    @property
    def alive(self) -> bool:
        return self in _ALIVE

    @property
    def coming(self) -> bool:
        """Whether the node is not at work yet: it waits, is starting, or will be restarted."""
        return self in _COMING


_ALIVE = frozenset({NodeState.STARTING, NodeState.READY, NodeState.RUNNING, NodeState.STOPPING})
_COMING = frozenset({NodeState.WAITING, NodeState.STARTING, NodeState.BACKOFF})


class Severity(str, Enum):
    """Severity of a log line: the five levels of rcutils."""

    DEBUG = "debug"
    INFO = "info"
    WARN = "warn"
    ERROR = "error"
    FATAL = "fatal"

    @property
    def rank(self) -> int:
        """Position in the order of severity, 0 for debug."""
        return _RANKS[self]


_BY_RANK = tuple(Severity)
_RANKS = {severity: rank for rank, severity in enumerate(Severity)}


STUCK = "stuck"
"""The kind of fault of a node that runs, with a callback that does not return."""
THREAD = "thread"
"""That of one that runs, and in which a thread has ended by an exception."""
IDLE = "idle"
"""That of one that came to its end without having done anything: main() is never called."""
HALTED = "halted"
"""That of one, whoever has written it, of which a signal has suspended a process."""


@dataclass(frozen=True)
class NodeFault:
    """What is wrong with a learner's own file, or with the process of any node."""

    kind: str
    """`syntax`: it cannot be read, and an older process may still run; `import`: a module is not
    there; `crash`: its process has ended by an exception; `warning`: it runs, but not as meant;
    `STUCK`, `THREAD`, `IDLE` and `HALTED`: see there."""
    file: str = ""
    """Absolute; empty where no file is to blame."""
    line: int = 0
    """From 1; 0 if unknown, as is the next."""
    column: int = 0
    source_line: str = ""
    exception: Sentence = ""
    """As Python words it: `NameError: name 'x' is not defined`."""
    meaning: Sentence = ""
    """A sentence for a beginner; empty if there is none for it."""

    @property
    def words(self) -> Words:
        # Some exceptions are whole sentences.
        exception = self.exception
        if type(exception) is str and self.meaning:
            exception = exception.removesuffix(".")
        if not self.file:
            return say("{exception}. {meaning}", exception=exception, meaning=self.meaning)
        place = say("{file}:{line}", file=self.file.rpartition("/")[2], line=self.line)
        if self.meaning:
            return say("{place}: {exception}. {meaning}", place=place, exception=exception, meaning=self.meaning)
        return say("{place}: {exception}", place=place, exception=exception)


@dataclass(frozen=True)
class NodeStatus:
    """The current state of one node of the running profile."""

    name: str
    """The node's key in the profile, which is also its name in the ROS graph."""
    command: str
    """The program, for display: `nodes.mock_sonar`, or the command line of an `exec:`."""
    state: NodeState
    detail: Sentence = ""
    """Why it is in this state, in words: what it is waiting for, or how it ended."""
    pid: int | None = None
    uptime_s: float | None = None
    restarts: int = 0
    """Restarts by the restart policy since the profile was started."""
    exit_code: int | None = None
    signal: str | None = None
    """Name of the signal that ended it: `SIGKILL`."""
    cpu_percent: float | None = None
    memory_bytes: int | None = None
    """Proportional set size of all the node's processes."""
    needs: tuple[str, ...] = ()
    file: str = ""
    """The learner's own file that it runs, absolute; empty for other nodes."""
    fault: NodeFault | None = None
    """What is wrong with that file, or with its process, as far as it has shown."""

    @property
    def ails(self) -> bool:
        """Whether something keeps it from its work, whatever its state: it is not healthy."""
        return self.fault is not None and self.fault.kind != "warning"

    @property
    def why(self) -> str:
        """Why it is as it is, in words: what keeps it from its work, else the detail."""
        return self.fault.words if self.ails and self.fault is not None else self.detail

    @property
    def late(self) -> bool:
        """Whether it runs but has not become ready in time."""
        return self.state is NodeState.RUNNING and self.detail.startswith(NOT_READY)

    @property
    def crashed(self) -> bool:
        """Whether it has ended by a mistake, and is not started again, or not yet."""
        return self.state in (NodeState.FAILED, NodeState.BACKOFF)

    @property
    def unasked(self) -> bool:
        """Whether only its process is known to run: nobody has asked whether it is at work.

        Of a learner's own program more is known: see `launcher.callback_watch`.
        """
        return self.state is NodeState.RUNNING and not self.late and not self.file

    @property
    def serves(self) -> bool:
        """Whether nodes that need it may start: it runs, and is ready if it has a condition."""
        return self.state in (NodeState.READY, NodeState.RUNNING) and not self.late


@dataclass(frozen=True, slots=True)
class LogLine:
    """One line written by a node, or by the supervisor about a node."""

    node: str
    seq: int
    """Counts this node's lines from 1 without gaps, so that a reader notices missing ones."""
    time_s: float
    """Unix time: the node's own stamp where the line has one, else the time of reading."""
    severity: Severity
    text: str
    """Text without escape sequences; control characters as their pictures (U+2400 on)."""
    logger: str = ""
    """Name of the ROS logger, empty for a plain line."""
    source: str = "stderr"
    """`stdout`, `stderr`, `deck` for the supervisor's own lines about the node, or `agent` for what
    is said about agents."""

    def packed(self) -> list[Any]:
        """Return it as JSON, in a short form: many are sent, and kept."""
        text = pack_text(self.text) if isinstance(self.text, Words) else self.text
        return [self.node, self.seq, self.time_s, self.severity.rank, text, self.logger, self.source]

    @classmethod
    def unpacked(cls, fields: list[Any]) -> LogLine:
        """Return the line that was packed."""
        node, seq, time_s, rank, text, logger, source = fields
        # Thousands of lines are kept, and these are the same in most of them.
        node, logger, source = map(sys.intern, (node, logger, source))
        return cls(node, seq, time_s, _BY_RANK[rank], unpack_text(text), logger, source)


@dataclass(frozen=True)
class Who:
    """A user and where they work, as far as known."""

    pid: int = 0
    user: str = ""
    tty: str = ""
    """`pts/3`, empty without a terminal."""
    host: str = ""
    """The address from which they logged in by SSH, empty if they did not."""


@dataclass(frozen=True)
class SessionInfo:
    """The running profile as a whole."""

    run_id: str
    profile: str
    """Path of the profile's file."""
    name: str
    """File name without its suffix: `09-brain`."""
    title: dict[str, str] = field(default_factory=dict)
    """Language code to title."""
    lesson: str = ""
    domain: int = 0
    discovery: str | tuple[str, ...] = "localhost"
    hardware: str = "mock"
    panels: tuple[str, ...] = ()
    supervisor_pid: int = 0
    log_dir: str = ""
    foreground: bool = True
    """Whether the nodes end with the screen that started them."""
    started_by: Who = Who()
    since_s: float = 0.0
    """Unix time of its start."""
    agents: AgentRules = DEFAULT_RULES
    """What agents may do."""


@dataclass(frozen=True)
class Stray:
    """A process that an earlier run left behind."""

    pid: int
    started_s: float
    """Start time of the process (unix time): a pid alone may have been reused."""
    node: str
    command: str
    run_id: str
