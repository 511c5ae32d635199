"""What can go wrong in the launcher, as exceptions with readable messages.

::

    LauncherError                   base of all; its text can be shown to the user as it is
    ├── UsageError                  the request is invalid, nothing was started (exit 2)
    │   ├── ProfileError            a profile that cannot be used; `.problems` has every problem
    │   ├── ProfileNotFoundError    no profile of that name; `.near` has similar names
    │   ├── DomainError             not a ROS domain, that is, a number from 0 to 232
    │   ├── DomainTakenError        another session is in the domain; `.free` is an unused one
    │   └── UnknownNodeError        the running profile has no node of that name
    ├── RunDirError                 the run or log directory is missing, full or not ours (exit 2)
    └── SessionError                an error that concerns a running supervisor (exit 1)
        ├── NotRunningError         no session runs, or none of that name
        ├── SeveralRunningError     more than one runs, choose one of `.names` (exit 2)
        ├── AlreadyRunningError     the same nodes already run there; `.session` (exit 2)
        ├── StartError              the supervisor ended before it answered (exit 2)
        ├── ConnectionLostError     the supervisor has gone, or does not answer
        ├── SilentSupervisorError   it does not answer, and was left alone or killed
        ├── StillRunningError       processes that should have ended still run
        └── ProtocolError           the other end speaks another version of the protocol
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from text.sentences import Words, say

if TYPE_CHECKING:
    from launcher.status import SessionInfo


class LauncherError(Exception):
    """Any request that the launcher refuses or fails to carry out."""

    exit_code = 1
    """Exit code of a command that ends with this error."""


class UsageError(LauncherError):
    """The request is invalid; nothing was started."""

    exit_code = 2


@dataclass(frozen=True)
class ProfileProblem:
    """One thing that is wrong in a profile.

    `line` and `column` count from 1; they are 0 if there is no position to point at. `message` and
    `hint` are `text.sentences.Words` wherever they come from this project.
    """

    file: str
    line: int
    column: int
    field: str
    """Path of the field, such as `nodes.sonar_front.params.rate`; empty for the whole file."""
    message: str
    hint: str = ""
    """How to fix it: what was probably meant, or what to write."""

    @property
    def where(self) -> str:
        """`file:line:column`, which editors and terminals make clickable."""
        return f"{self.file}:{self.line}:{self.column}" if self.line else self.file

    @property
    def words(self) -> Words:
        """One line: where, which field, what is wrong, how to fix it."""
        field = "{field}: " if self.field else ""
        hint = " ({hint})" if self.hint else ""
        values = {"field": self.field, "message": self.message, "hint": self.hint}
        return Words("{where}: " + field + "{message}" + hint, {"where": self.where, **values})

    def __str__(self) -> str:
        return str(self.words)


class ProfileError(UsageError):
    """A profile that cannot be used; holds every problem found, in order of position."""

    def __init__(self, problems: Iterable[ProfileProblem]) -> None:
        """Keep `problems`; there must be at least one."""
        self.problems: tuple[ProfileProblem, ...] = tuple(problems)
        super().__init__(*(problem.words for problem in self.problems))

    def __str__(self) -> str:
        return "\n".join(map(str, self.problems))


class ProfileNotFoundError(UsageError):
    """No profile of that name."""

    def __init__(self, name: str, near: Sequence[str] = ()) -> None:
        """`near`: names that may have been meant."""
        self.name = name
        self.near = tuple(near)
        if near:
            words = say("no profile {name!r}; did you mean {near}?", name=name, near=", ".join(near))
        else:
            words = say("no profile {name!r}; `deck list` shows them all", name=name)
        super().__init__(words)


class DomainError(UsageError):
    """Not a valid ROS domain."""


class DomainTakenError(UsageError):
    """Another session of this user is in the domain."""

    def __init__(self, domain: int, sessions: Sequence[Words], free: int, *, can_share: bool) -> None:
        """`sessions`: those in the domain; `free`: a domain that has none.

        `can_share`: whether both could run in it, merely seeing each other's topics.
        """
        self.domain = domain
        self.sessions = tuple(sessions)
        self.free = free
        self.can_share = can_share
        values: dict[str, object] = {"domain": domain, "first": sessions[0], "more": len(sessions) - 1, "free": free}
        super().__init__(
            say("in domain {domain} there is already {first} (and {more} more); `--domain {free}` is free", **values)
            if len(sessions) > 1
            else say("in domain {domain} there is already {first}; `--domain {free}` is free", **values)
        )


class UnknownNodeError(UsageError):
    """The running profile has no node of that name."""

    def __init__(self, name: str, known: Iterable[str]) -> None:
        """`known`: the names of the existing nodes."""
        self.name = name
        self.known = tuple(known)
        nodes = ", ".join(self.known)
        super().__init__(say("no node {name!r}; there are: {nodes}", name=name, nodes=nodes))


class RunDirError(LauncherError):
    """The run or log directory cannot be created or written, or belongs to another user."""

    exit_code = 2


class SessionError(LauncherError):
    """An error that concerns a running supervisor."""


class NotRunningError(SessionError):
    """No session is running, or none of that name."""

    def __init__(self, name: str | None = None, running: Sequence[str] = ()) -> None:
        """`name`: the requested session; `running`: the names of those that run."""
        self.name = name
        if name is None:
            words = say("nothing runs in the background; `deck up PROFILE` starts a profile")
        elif running:
            names = ", ".join(running)
            words = say("{name!r} is not running; running: {names}", name=name, names=names)
        else:
            words = say("{name!r} is not running, nor is anything else", name=name)
        super().__init__(words)


class SeveralRunningError(SessionError):
    """More than one session is running: choose one by name."""

    exit_code = 2

    def __init__(self, names: Sequence[str]) -> None:
        """`names`: those of the running sessions."""
        self.names = tuple(names)
        super().__init__(say("several profiles run, choose one by name: {names}", names=", ".join(names)))


class AlreadyRunningError(SessionError):
    """The same nodes, or others that drive the same wheels, already run in that domain."""

    exit_code = 2

    def __init__(self, session: SessionInfo, run_dir: str = "", down: str = "deck down", free: int = 0) -> None:
        """`session`: the running one; `run_dir`: its run directory if that is not ours.

        `down`: the command that stops it; `free`: a domain without a session.
        """
        self.session = session
        self.free = free
        values: dict[str, object] = {"name": session.name, "domain": session.domain, "pid": session.supervisor_pid}
        values |= {"run_dir": run_dir, "down": down, "free": free}
        super().__init__(
            say(
                "{name} is already running in domain {domain} (pid {pid}, run directory "
                "{run_dir}); `{down}` stops it, `--domain {free}` starts another beside it",
                **values,
            )
            if run_dir
            else say(
                "{name} is already running in domain {domain} (pid {pid}); `deck attach` shows "
                "it, `{down}` stops it, `--domain {free}` starts another beside it",
                **values,
            )
        )


class StartError(SessionError):
    """The supervisor ended before it answered."""

    exit_code = 2


class ConnectionLostError(SessionError):
    """The supervisor has gone, or does not answer."""


class SilentSupervisorError(SessionError):
    """The supervisor does not answer; the client has left it alone, or has killed it."""


class StillRunningError(SessionError):
    """Processes that were to end still run; the argument names them."""


class ProtocolError(SessionError):
    """The other end speaks another version of the protocol."""
